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

Measured threads(const Setting& set) {
  double worst = 0;
  std::vector<Vec3> first;
  for (const int n : {1, 2, 8}) {
    Scene s = cloud(set, .5);
    s.context.threads = n;
    for (int k = 0; k < 60; ++k) s.step();
    if (first.empty()) first = s.bodies.x;
    for (std::size_t i = 0; i < first.size(); ++i)
      worst = std::max(worst, (s.bodies.x[i] - first[i]).cwiseAbs().maxCoeff());
  }
  return {worst, 0};
}

// Five blocks on each other and a million steps: height lost per second over the block's size.
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
  return {std::abs(s.bodies.x[4].z() - top) / (kSize * (s.time - begun)), 1e-9};
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
      {"cloud of 27 grains: threads 1, 2, 8", "bitwise the same", "m", "none", Over::all_shapes,
       false, false, threads},
      {"quiet pile, 10^6 steps", "does not creep", "heights of a block a second", "local, 0.5",
       Over::flat_shapes, false, true, quiet_pile}};
  return cases;
}

}  // namespace trackbed::hard
