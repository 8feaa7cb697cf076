// The step itself: critical steps, momentum, energy, threads, a quiet pile.
#include "dem/grain/random.h"
#include "grain_scene.h"

namespace trackbed::hard {
namespace {

using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .05, kModulus = 1e8;

// A cube on the floor that moves up and down only: one spring, frequency known.
Scene one_spring(const Setting& set, double share_of_critical) {
  Scene s(kModulus, 0, set.law);
  const dem::GrainShape g = dem::make_grain_shape(solid("cube", kSize));
  dem::add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, 2600, {0, 0, .4999 * kSize}, g.turn,
                 dem::kMoveZ);
  s.add_floor(1, 1);
  s.prepare();
  const double depth = .0001 * kSize, k = s.bodies.force[0].z() / depth, m = s.bodies.mass[0];
  s.bodies.applied_force[0].z() = -.5 * k * depth;
  s.context.gravity.setZero();
  s.bodies.x[0].z() = .5 * kSize - .6 * depth;  // a tenth of the depth out of balance
  s.prepare();
  s.context.dt = share_of_critical * 2 / std::sqrt(k / m);
  return s;
}

double swing(Scene& s, int steps) {
  const double balance = .49995 * kSize, start = std::abs(s.bodies.x[0].z() - balance);
  double most = 0;
  for (int k = 0; k < steps; ++k) {
    s.step();
    most = std::max(most, std::abs(s.bodies.x[0].z() - balance));
  }
  return most / start;
}

// Verlet's amplitude at omega dt = 1.8: 1/sqrt(1 - 0.81) of the start's at most.
Measured below_critical(const Setting& set) {
  Scene s = one_spring(set, .9);
  return {swing(s, 5000), 1.001 / std::sqrt(1 - .81)};
}

// 0 if the measured limit says that this step is too large, and it is indeed.
Measured above_critical(const Setting& set) {
  Scene s = one_spring(set, 1.1);
  const bool seen = dem::measured_limit(s.bodies, s.pairs, 1).dt < s.context.dt;
  return {seen && swing(s, 100) > 5 ? 0. : 1., 0};
}

// Grains flying at each other, 3 x 3 x 3.
Scene cloud(const Setting& set, double mu) {
  Scene s = scene_of(set, kModulus, mu, kSize);
  s.context.gravity.setZero();
  dem::Random random(3);
  const dem::GrainShape g = grain(set.shape, kSize);
  const int shape = s.shapes.add(g);
  for (int k = 0; k < 27; ++k) {
    const Vec3 at(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const int i = dem::add_grain(s.bodies, s.shapes, shape, 0, 2600, 1.9 * g.radius * 1.1 * at,
                                 Quat(Eigen::AngleAxisd(random.uniform(0, 6), random.direction())));
    s.bodies.v[i] = -20 * s.bodies.x[i] + .3 * random.direction();
  }
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {.3, 6}).dt;
  return s;
}

Measured momentum(const Setting& set) {
  Scene s = cloud(set, .5);
  Vec3 before = Vec3::Zero(), after = before;
  double size = 0;
  for (int i = 0; i < s.bodies.size(); ++i) {
    before += s.bodies.mass[i] * s.bodies.v[i];
    size += s.bodies.mass[i] * s.bodies.v[i].norm();
  }
  for (int k = 0; k < 1500; ++k) s.step();
  for (int i = 0; i < s.bodies.size(); ++i) after += s.bodies.mass[i] * s.bodies.v[i];
  return {(after - before).norm() / size, 1e-12};
}

// Stored and kinetic energy against what was dissipated: what came from nowhere.
Measured ledger(const Setting& set) {
  Scene s = cloud(set, .5);
  for (int k = 0; k < 1500; ++k) s.step();
  return {std::abs(s.closure()) / s.start.kinetic, 1e-3, conservative(set)};
}

// Two grains head-on, elastic and without friction, needles across each other: what came from
// nowhere at most, over the energy.
double open_ledger(const Setting& set, double share) {
  Scene s = scene_of(set, kModulus, 0, kSize);
  s.context.gravity.setZero();
  const dem::GrainShape g = grain(set.shape, kSize);
  const Vec3 way = Vec3(1, .05, .08);
  s.add(g, 2600, -1.02 * g.radius * way, dem::turn_about({.1, .2, 1}, M_PI / 2 + .1) * g.turn);
  s.add(g, 2600, 1.02 * g.radius * way, dem::turn_about({.1, 1, .2}, M_PI / 2 + .1) * g.turn);
  for (double apart = 1.02; dem::count_contacts(s.pairs) == 0; apart *= .99) {  // nearly touching
    for (const int i : {0, 1}) s.bodies.x[i] = (i ? 1 : -1) * apart * g.radius * way;
    std::fill(s.pairs.wake.begin(), s.pairs.wake.end(), 0.0);  // moved by hand, not by a step
    s.prepare();
  }
  for (const int i : {0, 1}) {
    s.bodies.x[i] /= .98;
    s.bodies.v[i] = Vec3(i ? -.2 : .2, .01, i ? -.01 : .01);
  }
  s.prepare();
  s.context.dt = share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  double worst = 0;
  bool touched = false;
  for (long k = 0, away = 0; k < 2000000 && away < 20; ++k) {
    s.step();
    const bool now = dem::count_contacts(s.pairs) > 0;
    touched |= now;
    away = touched && !now ? away + 1 : 0;
    if (now || away == 1) worst = std::max(worst, std::abs(s.closure()) / s.start.kinetic);
  }
  return touched ? worst : HUGE_VAL;
}

constexpr double kFineShare = .0005;

Measured fine_ledger(const Setting& set) {
  return {open_ledger(set, kFineShare), 1e-6, set.law != "shao2017"};
}

Measured order_of_ledger(const Setting& set) {
  const double order =
      std::log(open_ledger(set, .04) / open_ledger(set, kFineShare)) / std::log(.04 / kFineShare);
  return {std::max(0., 2 - order), .4, set.law != "shao2017"};
}

Curve ledger_over_step(const Setting& set) {
  Curve c{"step over the limit", "energy from nowhere, share", true, true, {}};
  for (double share = .16; share > .9 * kFineShare; share /= 2)
    c.points.push_back({share, open_ledger(set, share)});
  return c;
}

// Ten blocks on each other, ten seconds (needles, of smaller steps, one): how far one has gone
// aside or turned, over its edge, and its speed. With torsional friction: without it faces turn
// about their normal, since a smaller face sinks in deeper. At 1e6 Pa a column of ten cubes
// buckles.
Measured stack(const Setting& set) {
  const bool needles = set.shape == "needle";
  Scene s(needles ? 1e6 : 1e7, .5, set.law);
  s.resistance.torsion = 1;
  const dem::Polyhedron body = solid(set.shape, kSize);
  const dem::GrainShape g = dem::make_grain_shape(body);
  const Vec3 edges = 2 * body.vertices[0].cwiseAbs();
  const int shape = s.shapes.add(g);
  for (int i = 0; i < 10; ++i)
    dem::add_grain(s.bodies, s.shapes, shape, 0, 2600, {0, 0, edges.z() * (i + .5)}, g.turn);
  s.add_floor(1, 1);
  s.candidates = dem::Candidates({.02 * edges.z(), true});
  s.prepare();
  s.context.dt = .2 * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 2}).dt;
  s.context.local_damping = .5;
  s.run(needles ? .2 : 1);
  s.context.local_damping = 0;
  s.run(s.time + (needles ? 1 : 10));
  double worst = 0;
  for (int i = 0; i < 10; ++i) {
    const double turned = (s.bodies.R[i] - g.turn.toRotationMatrix()).norm() / std::sqrt(2.);
    worst = std::max(
        {worst, s.bodies.x[i].head<2>().norm() / edges.minCoeff(), turned, s.bodies.v[i].norm()});
  }
  return {worst, 1e-4, set.law != "shao2017"};
}

// Five blocks on each other and a million steps: height lost per second over 1e-9 of the block's
// size, and kinetic energy over 1e-12 m g d, each in what is allowed.
Measured quiet_pile(const Setting& set) {
  Scene s(1e9, .5, set.law);
  for (int i = 0; i < 5; ++i) s.add_block({kSize, kSize, kSize}, 2600, {0, 0, kSize * (i + .5)});
  s.add_floor(1, 1);
  s.candidates = dem::Candidates({.005, true});
  s.prepare();
  s.context.dt = .2 * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 2}).dt;
  s.context.local_damping = .5;
  for (int k = 0; k < 50000; ++k) s.step();
  const double top = s.bodies.x[4].z(), begun = s.time;
  for (int k = 0; k < 1000000; ++k) s.step();
  const double creep = std::abs(s.bodies.x[4].z() - top) / (kSize * (s.time - begun));
  const double kinetic = s.now().kinetic / (s.bodies.mass[0] * 9.81 * kSize);
  return {std::max(creep / 1e-9, kinetic / 1e-12), 1};
}

}  // namespace

const std::vector<Case>& step_cases() {
  static const std::vector<Case> cases{
      {"step 0.9 of critical", "bounded as Verlet is", "amplitude over its start", "none",
       Over::flat_shapes, false, false, below_critical},
      {"step 1.1 of critical", "the monitor's limit is below it", "1 = unseen", "none",
       Over::flat_shapes, false, false, above_critical},
      {"cloud of 27 grains: momentum", "kept without outer load", "share of all momenta", "none",
       Over::all_shapes, true, false, momentum},
      {"cloud of 27 grains: ledger", "closes with friction", "share of the energy", "none",
       Over::all_shapes, true, false, ledger},
      {"elastic impact without friction, step 1/2000 of the limit", "the ledger closes",
       "share of the energy", "none", Over::all_shapes, false, false, fine_ledger,
       ledger_over_step},
      {"elastic impact without friction, smaller and smaller steps", "the ledger closes by order 2",
       "2 - order", "none", Over::all_shapes, false, false, order_of_ledger},
      {"stack of ten blocks, 10 s", "stands", "way over the edge, rad or m/s",
       "none after 1 s of local, 0.5; torsion 1", Over::flat_shapes, false, false, stack},
      {"quiet pile, 10^6 steps", "height drifts by < 1e-9 sizes a second, T < 1e-12 m g d",
       "of what is allowed", "local, 0.5", Over::flat_shapes, false, true, quiet_pile}};
  return cases;
}

}  // namespace trackbed::hard
