// Dilated blocks on their faces: at a tilt, at rest, on a path, on each other. Crowned faces under
// the laws of one ball, flat ones under hertz_flat.
#include "on_a_floor.h"

namespace trackbed::hard {
namespace {

using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e8;

// On the floor, sunk in by `depth` at its middle, turned by `tilt` about y through its centre.
Scene flat(const Setting& set, double mu, double depth, double tilt = 0, double base = 2) {
  Scene s = scene_of(set, kModulus, mu, kSize);
  const dem::GrainShape g = grain("dilated", kSize);
  s.add(g, 2600, {0, 0, .5 * kSize - depth}, dem::turn_about({0, 1, 0}, tilt) * g.turn);
  s.add_floor(base, 1);
  s.prepare();
  return s;
}

double force_at(const Setting& set, double depth) {
  return flat(set, .5, depth).bodies.force[0].z();
}

// At the depth that carries the weight.
Scene balanced(const Setting& set) {
  const double weight = 9.81 * flat(set, .5, 0).bodies.mass[0];
  double low = -.01 * kSize, high = .01 * kSize;  // crowned: its middle stands out
  while (high - low > 1e-17 * kSize) {
    const double middle = (low + high) / 2;
    if (middle == low || middle == high) break;
    (force_at(set, middle) < weight ? low : high) = middle;
  }
  Scene s = flat(set, .5, high);
  s.context.dt = set.share * dem::measured_limit(s.bodies, s.pairs, 1).dt;
  return s;
}

Measured tilt(const Setting& set) {
  const auto force = [&](double angle) {
    return flat(set, .5, 1e-4 * kSize, angle).bodies.force[0].z();
  };
  return {change_by_tilt(force), 1e-6};
}

// From a face on a face to an edge: no jump of force or torque at a small step of the angle.
double worst_jump(const Setting& set, double angle) {
  const auto at = [&](double a) {
    const Scene s = flat(set, 0, 1e-3 * kSize, a);
    return std::pair(s.bodies.force[0], s.bodies.torque[0]);
  };
  const double step = 1e-6 * angle;
  const auto [f, t] = at(angle);
  const auto [g, u] = at(angle + step);
  // All of the face's width moves by that; the force may follow the depth in full.
  return std::max((f - g).norm(), (t - u).norm() / kSize) / f.norm();
}
Measured from_flat_to_tilted(const Setting& set) {
  double worst = 0;
  for (double angle = 1e-6; angle < .5; angle *= 1.3)
    worst = std::max(worst, worst_jump(set, angle) / (1e-6 * angle * kSize / (1e-3 * kSize)));
  return {worst, 1};
}
Curve force_over_tilt(const Setting& set) {
  Curve c{"tilt [rad]", "force [N]", true, true, {}};
  for (double angle = 1e-6; angle < .5; angle *= 1.3)
    c.points.push_back({angle, flat(set, 0, 1e-3 * kSize, angle).bodies.force[0].z()});
  return c;
}

Measured at_rest(const Setting& set) { return {speed_at_rest(balanced(set)), 1e-10}; }

Measured drift_of_tilt(const Setting& set) { return {turned_at_rest(balanced(set)), 1e-9}; }

Measured toggles(const Setting& set) {
  const Scene s = flat(set, .5, -.02 * kSize);
  return {changes_of_contact(s, set, 1e-2, s.bodies.x[0].z(), 200000), 2};
}

// Over the end of its base, so that the area changes and the deepest ball does not.
Measured closed_path(const Setting& set) {
  const double base = .4 * kSize;
  const Scene s = flat(set, 0, 5e-3 * kSize, 0, base);
  const Vec3 middle(base - .1 * kSize, 0, s.bodies.x[0].z());
  const auto stored = [](Scene& at, double) { return at.now().normal; };
  return {work_of_closed_path(s, middle, 3e-4 * kSize, stored), 1e-10};
}

Measured turned_pair(const Setting& set) {
  Scene s = flat(set, 10, 1e-3 * kSize);
  // What rounding tilts the pair by moves the point of a crowned face by 1/crown as much.
  return {change_of_a_turned_pair(s, 1e-3 * kSize), 1e-9};
}

Measured base_size(const Setting& set) {
  const double depth = 1e-4 * kSize;
  const double small = flat(set, 0, depth, 0, 1).bodies.force[0].z();
  const double large = flat(set, 0, depth, 0, 100).bodies.force[0].z();
  return {std::abs(large / small - 1), 1e-8};
}

// Five blocks, two seconds: as in steps.cc.
Measured stack(const Setting& set) {
  Scene s = scene_of(set, 1e7, .5, kSize);
  s.resistance.torsion = 1;
  const dem::GrainShape g = grain("dilated", kSize);
  const int shape = s.shapes.add(g);
  const Vec3 aside = .02 * kSize * Vec3(1, .7, 0);  // of every other block: no walls that coincide
  for (int i = 0; i < 5; ++i)
    dem::add_grain(s.bodies, s.shapes, shape, 0, 2600, i % 2 * aside + Vec3(0, 0, kSize * (i + .5)),
                   g.turn);
  s.add_floor(1, 1);
  s.prepare();
  s.context.dt = .2 * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 2}).dt;
  s.context.local_damping = .5;
  s.run(1);
  const std::vector<Vec3> x = s.bodies.x;
  const std::vector<dem::Mat3> R = s.bodies.R;
  s.context.local_damping = 0;
  s.run(s.time + 2);
  double worst = 0;
  for (int i = 0; i < 5; ++i)
    worst = std::max({worst, (s.bodies.x[i] - x[i]).norm() / kSize,
                      (s.bodies.R[i] - R[i]).norm() / std::sqrt(2.), s.bodies.v[i].norm()});
  return {worst, 1e-4, set.law == "hertz_flat"};  // on crowned faces they rock on
}

}  // namespace

const std::vector<Case>& flat_cases() {
  const auto over = Over::dilated;
  static const std::vector<Case> cases{
      {"dilated, face on face, tilt 1e-14 to 1e-8", "the force of no tilt", "relative difference",
       "none", over, false, false, tilt},
      {"dilated, from a face to an edge, tilt 1e-6 to 0.5", "force and torque do not jump",
       "change over that of the depth", "none", over, false, false, from_flat_to_tilted,
       force_over_tilt},
      {"dilated block at rest", "stays at rest", "m/s", "local, 0.5", over, true, false, at_rest},
      {"dilated block at rest, undamped", "does not tilt", "rad", "none", over, true, false,
       drift_of_tilt},
      {"dilated, face on face, coming and going", "touches once, leaves once", "changes", "none",
       over, true, false, toggles},
      {"dilated, face on face, closed path over an end", "no work", "share of the stored energy",
       "none", over, false, false, closed_path},
      {"dilated, face on face, stuck pair turned by 360 degrees", "the force turns along",
       "share of the sideways force", "none", over, false, false, turned_pair},
      {"dilated block on a base of 2 or 200 m", "penetration does not depend on the base",
       "relative difference", "none", over, false, false, base_size},
      {"stack of five dilated blocks, 2 s", "stands", "way over the edge, rad or m/s",
       "none after 1 s of local, 0.5; torsion 1", over, false, false, stack}};
  return cases;
}

}  // namespace trackbed::hard
