// What slides without friction over the facets of a level surface, cut unevenly, at rest on its
// spring: nothing lifts it or lets it down where it crosses an element's edge. No damping.
#include "dem/surface/round_patch.h"
#include "grain_scene.h"
#include "surface_scene.h"

namespace trackbed::hard {
namespace {

using dem::PatchScene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e7, kSpeed = 1;

// Balanced on the patch at its lower left, sunk in by `depth`.
PatchScene balanced(const Setting& set, double depth) {
  PatchScene s(dem::uneven_mesh(23, 17), .02, .1, kModulus, 0,
               is_round(set) ? "stored_energy" : set.law);
  const dem::GrainShape g = grain(set.shape, kSize);
  dem::Quat q = g.turn;
  double low = g.radius;
  if (is_round(set)) {
    dem::PairMaterial m = s.materials(0, 0);
    m.stiffness = kModulus * kSize;
    s.materials.set(0, 0, m);
    s.law = dem::make_round_patch_forces(set.law, false);
    if (set.shape == "dilated") low = kSize / 2;
    if (set.shape == "clump") {  // on one of its spheres
      q = dem::Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, -1)) * g.turn;
      low = .2 * std::sqrt(3.) * kSize + .3 * kSize;
    }
  } else {
    q = dem::turn_about({0, 0, 1}, .4) * g.turn;
    low = 0;
    for (const Vec3& p : g.body.vertices) low = std::max(low, -(q * p).z());
  }
  s.travel.push_back(0);
  dem::add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, 2600, {-.5, -.31, low - depth}, q,
                 dem::kMoveX | dem::kMoveY | dem::kMoveZ);
  s.evaluate_afresh();
  s.context.gravity = {0, 0, -s.bodies.force[0].z() / s.bodies.mass[0]};
  // The face of a dilated grain is crowned: its edge is not the lowest.
  s.context.dt =
      .1 / std::sqrt(1.5 * std::max(1e-9, s.bodies.force[0].z()) / depth / s.bodies.mass[0]);
  s.bodies.v[0] = kSpeed * Vec3(1, .7, 0);
  return s;
}

double bound(const Setting& set) { return is_round(set) ? 1e-10 : 1e-12; }

Measured sliding(const Setting& set) {
  PatchScene s = balanced(set, 1e-4 * kSize);
  if (!(s.bodies.force[0].z() > 0)) return {HUGE_VAL, bound(set)};
  double most = 0;
  while (s.bodies.x[0].x() < .4) {
    s.step();
    most = std::max(most, std::abs(s.bodies.v[0].z()));
  }
  return {most, bound(set)};
}

Curve speed_over_place(const Setting& set) {
  Curve c{"place [m], elements 0.09 m", "speed upwards [m/s]", false, false, {}};
  PatchScene s = balanced(set, 1e-4 * kSize);
  for (long k = 0; s.bodies.x[0].x() < .4; ++k) {
    s.step();
    if (k % 40 == 0) c.points.push_back({s.bodies.x[0].x(), s.bodies.v[0].z()});
  }
  return c;
}

}  // namespace

const std::vector<Case>& facet_cases() {
  static const std::vector<Case> cases{
      {"sliding over coplanar facets and element edges", "no bump: no speed upwards at 1 m/s",
       "m/s", "none", Over::level_shapes, false, false, sliding, speed_over_place}};
  return cases;
}

}  // namespace trackbed::hard
