// Edges and corners of polyhedra on each other: crossing edges down to parallel, a corner that
// passes over a corner and over an edge. Held or led bodies, no friction, no damping.
#include "hard_case.h"
#include "motion_scene.h"

namespace trackbed::hard {
namespace {

using dem::Mat3;
using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e8, kDegree = M_PI / 180;

// Force on the upper of two boxes; each has an edge pointing at the other, faces at 45 degrees, the
// edges crossing at `angle` and overlapping by `depth`. By symmetry (half a turn about the common
// normal) it is along z. The upper edge is the longer one: ends that lie in one plane are a kink of
// the energy.
Vec3 edge_on_edge(const Setting& set, double angle, double depth) {
  Scene s(kModulus, 0, set.law);
  dem::Polyhedron box = solid(set.shape, kSize);
  const Vec3 corner = box.vertices[0].cwiseAbs();
  const Quat up = dem::turn_about({1, 0, 0}, M_PI / 4);
  const Vec3 edge = up * Vec3(0, corner.y(), corner.z());
  const Quat over = dem::turn_about({0, 0, 1}, angle) * dem::turn_about({1, 0, 0}, M_PI);
  const dem::GrainShape lower = dem::make_grain_shape(box);
  s.add(lower, 2600, -edge, up * lower.turn);
  for (Vec3& p : box.vertices) p.x() *= 1.3;
  const dem::GrainShape upper = dem::make_grain_shape(box);
  s.add(upper, 2600, over * -edge - Vec3(0, 0, depth), over * up * upper.turn);
  s.prepare();
  return s.bodies.force[1];
}

constexpr double kDepth = 1e-4 * kSize;

// From 90 to 1e-12 degrees, and parallel at last: the direction's error and the jump of the force
// over a millionth of the angle. Force falls no faster than 1/angle, so that more is a jump.
Measured crossing_edges(const Setting& set) {
  double worst = 0;
  for (double degrees = 90; degrees > 1e-12; degrees /= 1.7) {
    const Vec3 f = edge_on_edge(set, degrees * kDegree, kDepth),
               g = edge_on_edge(set, degrees * kDegree * (1 + 1e-6), kDepth);
    if (!(f.z() > 0)) return {HUGE_VAL, 2e-6};
    worst = std::max({worst, f.head<2>().norm() / f.norm(), (f - g).norm() / f.norm()});
  }
  const Vec3 nearly = edge_on_edge(set, 1e-12 * kDegree, kDepth),
             parallel = edge_on_edge(set, 0, kDepth);
  return {std::max(worst, (nearly - parallel).norm() / parallel.norm()), 2e-6,
          set.law != "shao2017"};  // d of its Eq. 17 has kinks
}

Curve force_over_angle(const Setting& set) {
  Curve c{"crossing angle [degrees]", "force [N]", true, true, {}};
  for (double degrees = 90; degrees > 1e-12; degrees /= 1.3)
    c.points.push_back({degrees, edge_on_edge(set, degrees * kDegree, kDepth).norm()});
  return c;
}

// Pose that turns the corner farthest from the centre along `way`, and that corner's distance.
struct Corner {
  Quat turn;
  double far;
};
Corner corner_along(const dem::GrainShape& g, const Vec3& way) {
  Vec3 most = Vec3::Zero();
  for (const Vec3& p : g.body.vertices)
    if (p.norm() > most.norm() * (1 + 1e-9)) most = p;
  return {Quat::FromTwoVectors(most, way), most.norm()};
}

// A corner that points down at `depth` below the top of a corner or an edge that points up, `aside`
// of it in y and at x.
Scene corner_over(const Setting& set, bool edge, double depth, double x, double aside) {
  Scene s(kModulus, 0, set.law);
  s.context.gravity.setZero();
  const dem::GrainShape g = dem::make_grain_shape(solid(set.shape, kSize));
  const int shape = s.shapes.add(g);
  const Corner down = corner_along(g, {0, 0, -1}), up = corner_along(g, {0, 0, 1});
  dem::add_grain(s.bodies, s.shapes, shape, 0, 2600, {x, aside, down.far - depth}, down.turn,
                 dem::kMoveX);
  if (edge)
    dem::add_rigid_body(s.bodies, s.shapes, dem::make_box({kSize, kSize, kSize}), 0, 1,
                        {0, 0, -kSize / std::sqrt(2.)}, dem::turn_about({0, 1, 0}, M_PI / 4),
                        dem::kFixed);
  else
    dem::add_grain(s.bodies, s.shapes, shape, 0, 2600, {0, 0, -up.far}, up.turn, dem::kFixed);
  s.prepare();
  return s;
}

// Overlap becomes nothing with the depth: a corner's volume by depth^3, so that no law's force may
// fall by less than the depth itself does.
Measured force_fades(const Setting& set) {
  double worst = 0;
  for (const bool edge : {false, true})
    for (const double aside : {-1e-9, 1e-9})
      for (double depth = 1e-3, last = 0; depth > 1e-8; depth /= 10) {
        const Scene s = corner_over(set, edge, depth * kSize, 0, aside * kSize);
        const double now = s.pairs.size() ? s.pairs.force[0].norm() : 0;
        if (last > 0) worst = std::max(worst, now / last);
        if (depth == 1e-3 && !(now > 0)) return {HUGE_VAL, .1};
        last = now;
      }
  return {worst, .1};
}

// Led over it along x with much more speed than it takes: kinetic energy after and before.
Measured passing(const Setting& set) {
  double worst = 0;
  for (const bool edge : {false, true})
    for (const double aside : {-1e-9, 1e-9}) {
      const double way = .1 * kSize;
      Scene s = corner_over(set, edge, 5e-4 * kSize, -way, aside * kSize);
      s.bodies.v[0].x() = .5;
      s.prepare();
      s.context.dt = 1e-4 * way / .5;
      const double before = s.now().kinetic;
      double peak = 0;
      while (s.bodies.x[0].x() < way) {
        s.step();
        peak = std::max(peak, before - s.now().kinetic);
      }
      if (!(peak > 0) || dem::count_contacts(s.pairs) > 0) return {HUGE_VAL, 1e-3};
      worst = std::max(worst, std::abs(s.now().kinetic - before) / peak);
    }
  return {worst, 1e-3, set.law != "shao2017"};
}

}  // namespace

const std::vector<Case>& edge_cases() {
  static const std::vector<Case> cases{
      {"edge on edge, crossing angle 90 to 1e-12 degrees", "along the common normal, no jump",
       "share of the force", "none", Over::flat_shapes, false, false, crossing_edges,
       force_over_angle},
      {"corner over corner and edge, 1e-9 aside: force", "fades with the overlap",
       "over that of ten times the depth", "none", Over::shapes, false, false, force_fades},
      {"corner over corner and edge, 1e-9 aside: passing", "keeps the energy",
       "share of what the passing takes at most", "none", Over::shapes, false, false, passing}};
  return cases;
}

}  // namespace trackbed::hard
