// Impacts and starts that break codes. No damping, no gravity.
#include "base/error.h"
#include "dem/motion/monitor.h"
#include "grain_scene.h"

namespace trackbed::hard {
namespace {

using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e8;

int add(Scene& s, const std::string& shape, double size, double rho, const Vec3& x, const Quat& q) {
  const dem::GrainShape g = grain(shape, size);
  return dem::add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, rho, x, q * g.turn);
}

// Just above the floor, turned, thrown at it.
Scene thrown(const Setting& set, double scale, double mu, const Vec3& v) {
  Scene s = scene_of(set, kModulus, mu, scale * kSize);
  s.context.gravity.setZero();
  const Quat turned = dem::turn_about({1, 2, .5}, .9);
  const int body = add(s, set.shape, scale * kSize, 2600, Vec3::Zero(), turned);
  double low = 0;
  const dem::GrainShape& g = s.shapes.shape(s.bodies.shape[body]);
  if (is_round(set))
    low = -g.radius;
  else
    for (const Vec3& p : g.body.vertices) low = std::min(low, (s.bodies.R[body] * p).z());
  s.bodies.x[body].z() = -low + 1e-3 * scale * kSize;
  s.add_floor(20 * scale * kSize, 5 * scale * kSize);
  s.bodies.v[body] = v;
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  return s;
}

// Until it has left, or some thousand steps.
bool collide(Scene& s) {
  bool touched = false;
  for (int k = 0, away = 0; k < 20000 && away < 200; ++k) {
    s.step();
    const bool now = dem::count_contacts(s.pairs) > 0;
    touched |= now;
    away = touched && !now ? away + 1 : 0;
  }
  return touched;
}

Measured grazing(const Setting& set) {
  double most = -1;
  for (const double mu : {0., .5, 2.})
    for (const double degrees : {0., 30., 60., 80., 89.}) {
      const double a = degrees * M_PI / 180;
      Scene s = thrown(set, 1, mu, 2 * Vec3(std::sin(a), 0, -std::cos(a)));
      const double before = s.now().total();
      if (!collide(s)) return {HUGE_VAL, 1e-3};
      most = std::max(most, s.now().kinetic / before - 1);
    }
  return {most, 1e-3, conservative(set)};
}

// Middle of the highest (sign 1) or lowest (-1) corners, from the body's centre.
Vec3 end_of(const Scene& s, int body, double sign) {
  const dem::Polyhedron& solid = s.shapes.shape(s.bodies.shape[body]).body;
  double most = -HUGE_VAL;
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const Vec3& p : solid.vertices) most = std::max(most, sign * (s.bodies.R[body] * p).z());
  for (const Vec3& p : solid.vertices) {
    const Vec3 turned = s.bodies.R[body] * p;
    if (sign * turned.z() > most - 1e-9 * kSize) sum += turned, ++count;
  }
  return sum / count;
}

// The second on top of the first, overlapping by a tenth of their height or, if round, diameter.
Measured overlapping_start(const Setting& set) {
  Scene s = scene_of(set, kModulus, .5, kSize);
  if (!is_round(set) && !s.forces.stores_energy) return {NAN, 1e-3, false};
  s.context.gravity.setZero();
  add(s, set.shape, kSize, 2600, Vec3::Zero(), Quat::Identity());
  const int b = add(s, set.shape, kSize, 2600, Vec3::Zero(), dem::turn_about({0, 0, 1}, .3));
  if (is_round(set)) {
    const double diameter = 2 * s.shapes.shape(s.bodies.shape[b]).radius;
    s.bodies.x[b] = {0, 0, diameter};
    for (int k = 0; k < 200; ++k) {  // down until they do
      s.bodies.x[b].z() -= .01 * diameter;
      std::fill(s.pairs.wake.begin(), s.pairs.wake.end(), 0.0);  // moved by hand, not by a step
      s.prepare();
      if (count_contacts(s.pairs) > 0) break;
    }
    s.bodies.x[b].z() -= .1 * kSize;
    std::fill(s.pairs.wake.begin(), s.pairs.wake.end(), 0.0);
  } else {
    const Vec3 top = end_of(s, 0, 1), bottom = end_of(s, b, -1);
    s.bodies.x[b] = top - bottom - Vec3(0, 0, .1 * (top.z() - bottom.z()));
  }
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  const double stored = s.start.normal;
  if (!(stored > 0)) return {HUGE_VAL, 1e-3};
  collide(s);
  return {s.now().kinetic / stored - 1, 1e-3, conservative(set)};
}

// 4 mm thin, 30 m/s: stopped, or the run is refused. 1 if it came out on the other side unseen.
Measured tunnelling(const Setting& set) {
  if (set.shape == "tetrahedron" || set.shape == "voronoi") return {NAN, 0, false};  // not so thin
  const double thickness = .004;
  Scene s = scene_of(set, kModulus, .5, thickness);
  s.context.gravity.setZero();
  const double scale = is_round(set)          ? .004
                       : set.shape == "plate" ? .04
                       : set.shape == "cube"  ? .004
                                              : .08;
  add(s, set.shape, scale, 2600, {0, 0, thickness}, Quat::Identity());
  dem::add_box(s.bodies, s.shapes, {-1, -1, -thickness}, {1, 1, 0}, 0, 1, dem::kFixed);
  s.bodies.v[0].z() = -30;
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  try {
    for (int k = 0; k < 4000 && std::abs(s.bodies.x[0].z()) < .1; ++k) {
      s.step();
      dem::check_state(s.bodies, s.shapes, s.pairs, s.context, k);
    }
  } catch (const RunError&) {
    return {0, 0};
  }
  return {s.bodies.v[0].z() < 0 ? 1. : 0., 0};
}

Measured lengths(const Setting& set) {
  Vec3 place = Vec3::Zero();
  double worst = 0;
  for (const double scale : {1., 1e-9, 1e6}) {
    Scene s = thrown(set, scale, .5, {.5, 0, -2});
    for (int k = 0; k < 3000; ++k) s.step();
    if (scale == 1) place = s.bodies.x[0];
    worst = std::max(worst, (s.bodies.x[0] / scale - place).norm() / place.norm());
  }
  return {worst, 1e-10};
}

// Masses 1:10^4, the chip between a heavy grain and the floor.
Measured mass_ratio(const Setting& set) {
  const double small = .01, large = small * std::cbrt(1e4);
  Scene s = scene_of(set, 5e10, .5, small);
  s.context.gravity.setZero();
  const auto height = [&](double size) {
    if (is_round(set)) return size;
    double low = 0, high = 0;
    for (const Vec3& p : solid(set.shape, size).vertices)
      low = std::min(low, p.z()), high = std::max(high, p.z());
    return high - low;
  };
  add(s, set.shape, small, 2600, {0, 0, .5 * height(small)}, Quat::Identity());
  add(s, set.shape, large, 2600, {0, 0, height(small) + .5 * height(large)}, Quat::Identity());
  s.add_floor(2, 1);
  s.bodies.v[1].z() = -.05;
  s.candidates = dem::Candidates({.001, true});
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  double deepest = 0;
  for (int k = 0; k < 12000; ++k) {
    s.step();
    if (k % 10 == 0)
      for (int p = 0; p < s.pairs.size(); ++p)
        if (s.pairs.touching[p]) deepest = std::max(deepest, s.pairs.depth[p]);
  }
  return {deepest / height(small), .05};
}

// Moduli 1:10^6: the soft one against a hard floor.
Measured stiffness_ratio(const Setting& set) {
  Scene s = thrown(set, 1, .3, {.1, 0, -.2});
  dem::PairMaterial m = s.materials(0, 0);
  s.materials = dem::PairMaterials(2);
  m.modulus = kModulus;
  s.materials.set(0, 0, m);
  m.modulus = dem::mixed_modulus(kModulus, 1e6 * kModulus);
  s.materials.set(0, 1, m), s.materials.set(1, 0, m);
  m.modulus = 1e6 * kModulus;
  s.materials.set(1, 1, m);
  s.bodies.material[1] = 1;
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  const double before = s.now().total();
  if (!collide(s)) return {HUGE_VAL, 1e-3};
  return {s.now().kinetic / before - 1, 1e-3, conservative(set)};
}

// Two grains that touch across the seam, against the same two side by side.
Measured across_the_seam(const Setting& set) {
  const auto pair = [&](bool seam) {
    Scene s = scene_of(set, kModulus, .5, kSize);
    s.context.gravity.setZero();
    const double period = 20 * kSize;
    if (seam) s.context.period = {0, period, 0};
    const dem::GrainShape g = grain(set.shape, kSize);
    const int shape = s.shapes.add(g);
    const double gap = 1.9 * g.radius;
    const double y = seam ? period / 2 - .5 * gap : -.5 * gap;
    const double aside = set.law == "hertz_flat" ? .03 * kSize : 0;  // no walls that coincide
    for (const double side : {y, seam ? -period / 2 + .5 * gap : .5 * gap})
      dem::add_grain(s.bodies, s.shapes, shape, 0, 2600,
                     {side == y ? aside : 0, side, side == y ? .7 * aside : 0}, Quat::Identity(),
                     dem::kFree);
    s.bodies.v[0].y() = .5, s.bodies.v[1].y() = -.5;
    s.prepare();
    s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
    bool touched = false;
    for (int k = 0; k < 20000; ++k) {
      s.step();
      const bool now = dem::count_contacts(s.pairs) > 0;
      if (touched && !now) break;
      touched |= now;
    }
    return s.bodies.v[0];
  };
  const Vec3 inside = pair(false);
  return {(pair(true) - inside).norm() / inside.norm(), 1e-9};
}

// Two that start with an overlap over a floor: what that throws apart comes to rest under gravity.
// Kinetic energy left over m g d.
Measured comes_to_rest(const Setting& set) {
  Scene s = scene_of(set, kModulus, .5, kSize);
  const dem::GrainShape g = grain(set.shape, kSize);
  add(s, set.shape, kSize, 2600, {0, 0, g.radius}, Quat::Identity());
  const int b =
      add(s, set.shape, kSize, 2600, {0, 0, 3.2 * g.radius}, dem::turn_about({0, 0, 1}, .3));
  s.add_floor(20, 1);
  s.resistance.rolling = .2, s.resistance.torsion = 1;  // else nothing stops a spin
  for (int k = 0; k < 1000; ++k) {  // down until they overlap by some hundredths
    s.bodies.x[b].z() -= 2e-3 * kSize;
    std::fill(s.pairs.wake.begin(), s.pairs.wake.end(), 0.0);
    s.prepare();
    if (dem::deepest_overlap(s.bodies, s.shapes, s.pairs).share > .02) break;
  }
  s.context.dt = .2 * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 2}).dt;
  s.context.local_damping = .5;
  s.run(3);
  return {s.now().kinetic / (s.bodies.mass[0] * 9.81 * kSize), 1e-6};
}

Curve energy_over_angle(const Setting& set) {
  Curve c{"angle of impact [degrees]", "kinetic energy after over before", false, false, {}};
  for (double degrees = 0; degrees <= 89; degrees += 4.45) {
    const double a = degrees * M_PI / 180;
    Scene s = thrown(set, 1, .5, 2 * Vec3(std::sin(a), 0, -std::cos(a)));
    const double before = s.now().total();
    collide(s);
    c.points.push_back({degrees, s.now().kinetic / before});
  }
  return c;
}

}  // namespace

const std::vector<Case>& impact_cases() {
  static const std::vector<Case> cases{
      {"grazing impact, 0 to 89 degrees, friction 0 to 2", "no kinetic energy is gained",
       "share of the energy before", "none", Over::all_shapes, true, false, grazing,
       energy_over_angle},
      {"overlapping start", "leaves with no more than was stored", "excess over stored energy",
       "none", Over::all_shapes, true, false, overlapping_start},
      {"overlapping start on a floor", "comes to rest", "kinetic energy over m g d",
       "local, 0.5; rolling .2, torsion 1", Over::all_shapes, false, false, comes_to_rest},
      {"impact across the periodic seam", "as inside", "relative difference of the speed", "none",
       Over::all_shapes, true, false, across_the_seam},
      {"tunnelling: 4 mm at 30 m/s", "met, or the run is refused", "1 = passed unseen", "none",
       Over::all_shapes, true, false, tunnelling},
      {"lengths times 1e-9 to 1e6", "the same dimensionless motion", "relative difference", "none",
       Over::all_shapes, false, false, lengths},
      {"mass 1:10^4", "the chip's penetration stays small", "share of its height", "none",
       Over::all_shapes, true, false, mass_ratio},
      {"stiffness 1:10^6", "no kinetic energy is gained", "share of the energy before", "none",
       Over::all_shapes, true, false, stiffness_ratio}};
  return cases;
}

}  // namespace trackbed::hard
