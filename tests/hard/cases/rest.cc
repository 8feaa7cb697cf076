// Face on face, at rest, held on a path. Bodies that stand on a flat face.
#include "on_a_floor.h"

namespace trackbed::hard {
namespace {

using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e8;

double height(const std::string& shape) {
  double high = 0;
  for (const Vec3& p : solid(shape, kSize).vertices) high = std::max(high, 2 * p.z());
  return high;
}

// Flat on the floor, sunk in by `depth`, turned by `tilt` about y through its centre.
Scene flat(const Setting& set, double mu, double depth, double tilt = 0,
           std::uint8_t freedom = dem::kFree, double base = 2) {
  Scene s(kModulus, mu, set.law);
  const dem::GrainShape g = dem::make_grain_shape(solid(set.shape, kSize));
  dem::add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, 2600,
                 {0, 0, .5 * height(set.shape) - depth}, dem::turn_about({0, 1, 0}, tilt) * g.turn,
                 freedom);
  s.add_floor(base, 1);
  s.prepare();
  return s;
}

// Force grows in proportion to depth, face on face: the depth that carries the weight.
Scene balanced(const Setting& set, std::uint8_t freedom = dem::kFree) {
  const double trial = 1e-6 * kSize;
  Scene s = flat(set, .5, trial);
  const double weight = 9.81 * s.bodies.mass[0];
  Scene at_rest = flat(set, .5, trial * weight / s.bodies.force[0].z(), 0, freedom);
  at_rest.context.dt = set.share * dem::measured_limit(at_rest.bodies, at_rest.pairs, 1).dt;
  return at_rest;
}

// In tilts from 1e-14 to 1e-8 rad a face stays a face: its force is that of no tilt.
Measured tilt(const Setting& set) {
  const auto force = [&](double angle) {
    return flat(set, .5, 1e-4 * kSize, angle).bodies.force[0].z();
  };
  return {change_by_tilt(force), 1e-6, set.law != "shao2017"};  // d of Eq. 17 has a kink there
}

// Area of the overlap with the floor of a box that is turned by `angle` about y and sunk in by
// `depth` at its centre: its section at z = 0, as wide as what lies below.
double section(const Vec3& edges, double angle, double depth) {
  const double hx = .5 * edges.x(), hz = .5 * edges.z();
  const double centre = hz - depth;
  const double low = hx * std::sin(angle) + hz * std::cos(angle) - centre;  // below the floor
  const double other = hz * std::cos(angle) - hx * std::sin(angle) - centre;
  const double length =
      other > 0 ? 2 * hx / std::cos(angle) : low / std::tan(angle) + low * std::tan(angle);
  return length * edges.y();
}

// From a face on a face to a wedge, where an end has come out of the floor.
Measured tilted_area(const Setting& set) {
  const double depth = 1e-5 * kSize;
  const dem::Polyhedron box = solid(set.shape, kSize);
  const Vec3 edges = 2 * box.vertices[0].cwiseAbs();
  double worst = 0;
  for (double angle = 1e-14; angle < 2e-3; angle *= std::sqrt(10.))
    worst = std::max(
        worst,
        std::abs(flat(set, .5, depth, angle).pairs.area[0] / section(edges, angle, depth) - 1));
  return {worst, 1e-9};
}

Curve force_over_tilt(const Setting& set) {
  Curve c{"tilt [rad]", "force [N]", true, true, {}};
  for (double angle = 1e-14; angle < 2e-3; angle *= 1.5)
    c.points.push_back({angle, flat(set, .5, 1e-5 * kSize, angle).bodies.force[0].z()});
  return c;
}

Measured at_rest(const Setting& set) { return {speed_at_rest(balanced(set)), 1e-10}; }

Measured drift_of_tilt(const Setting& set) {
  return {turned_at_rest(balanced(set)), 1e-9, set.law != "shao2017"};
}

Measured base_size(const Setting& set) {
  const double depth = 1e-5 * kSize;
  const double small = flat(set, 0, depth, 0, dem::kFree, 1).bodies.force[0].z();
  const double large = flat(set, 0, depth, 0, dem::kFree, 100).bodies.force[0].z();
  return {std::abs(large / small - 1), 1e-8};
}

// Comes down face on and goes up again: it touches once and leaves once.
Measured toggles(const Setting& set) {
  return {changes_of_contact(flat(set, .5, -1e-9), set, 1e-3, .5 * height(set.shape) + 1e-6, 20000),
          2};
}

// Over the end of its base, so that the contact's area changes.
Measured closed_path(const Setting& set) {
  const double depth = 1e-3 * kSize;
  const Scene s = flat(set, 0, depth, 0, dem::kFree, .45 * kSize);
  // Half of force times depth: what a face on a face stores.
  const auto stored = [depth](const Scene& at, double up) {
    return .5 * at.bodies.force[0].z() * (depth - up);
  };
  const Vec3 middle(.3 * kSize, 0, s.bodies.x[0].z());
  return {work_of_closed_path(s, middle, 3e-4 * kSize, stored), 1e-10, set.law != "shao2017"};
}

Measured turned_pair(const Setting& set) {
  Scene s = flat(set, 10, 1e-3 * kSize);
  return {change_of_a_turned_pair(s, 1e-3 * kSize), 1e-10};
}

}  // namespace

const std::vector<Case>& rest_cases() {
  static const std::vector<Case> cases{
      {"face on face, tilt 1e-14 to 1e-8", "the force of no tilt", "relative difference", "none",
       Over::flat_shapes, false, false, tilt},
      {"face on face, tilt 1e-14 to 1e-3", "the overlap's area is the section's",
       "relative difference", "none", Over::flat_shapes, false, false, tilted_area,
       force_over_tilt},
      {"block at rest", "stays at rest", "m/s", "local, 0.5", Over::flat_shapes, true, false,
       at_rest},
      {"block at rest, undamped", "does not tilt", "rad", "none", Over::flat_shapes, true, false,
       drift_of_tilt},
      {"small block on a base of 2 or 200 m", "penetration does not depend on the base",
       "relative difference", "none", Over::flat_shapes, false, false, base_size},
      {"nearly touching, coming and going", "touches once, leaves once", "changes", "none",
       Over::flat_shapes, true, false, toggles},
      {"closed path of a held grain", "no work", "share of the stored energy", "none",
       Over::flat_shapes, false, false, closed_path},
      {"stuck pair turned by 360 degrees", "the force turns along", "share of the sideways force",
       "none", Over::flat_shapes, false, false, turned_pair}};
  return cases;
}

}  // namespace trackbed::hard
