#include "dem/surface/round_patch.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dem/contact/deepest_balls.h"
#include "dem/contact/laws/hertz_flat.h"
#include "dem/contact/laws/hertz_mindlin.h"
#include "dem/contact/laws/linear.h"
#include "dem/contact/laws/sun2015.h"
#include "dem/contact/round_response.h"
#include "dem/surface/patch_evaluate.h"
#include "dem/surface/shell_cell.h"

namespace trackbed::dem {
namespace {

struct SurfaceBalls {
  double overlap = -HUGE_VAL;
  double reach = 0;  // r at the deepest point
  Vec3 n, y;         // into the surface; on the surface, relative to the grain's centre
  int triangle = -1;
  double weight[3];
};

// The point of a patch nearest to a sphere's centre. The triangles there alone say on which side
// the centre lies: one that stands beside a sleeper is behind its underside too, but farther off.
struct NearestPoint {
  double distance = HUGE_VAL;
  double height = 0;  // of the centre over the most face-on of the triangles that share the point
  Vec3 y = Vec3::Constant(HUGE_VAL), normal;
  int triangle = -1;
  double weight[3];
};

// Corners relative to the grain's centre.
struct Corners {
  Vec3 p[3];
  Corners(const SurfacePatch& patch, int triangle, const Vec3& offset) {
    for (int j = 0; j < 3; ++j) p[j] = patch.node[patch.triangle[triangle][j]] + offset;
  }
  Vec3 normal() const { return (p[1] - p[0]).cross(p[2] - p[0]).normalized(); }
};

void try_point(const Vec3& centre, const Corners& t, int triangle, NearestPoint& best) {
  double weight[3];
  const Vec3 y = closest_on_triangle(centre, t.p[0], t.p[1], t.p[2], weight);
  const double distance = (centre - y).norm();
  // Distances that round to the same have points up to sqrt(epsilon) apart.
  const bool same = (y - best.y).squaredNorm() < 1e-14 * (t.p[0] - t.p[1]).squaredNorm();
  if (!(distance < best.distance || same)) return;
  const Vec3 normal = t.normal();
  const double height = normal.dot(centre - y);
  if (!same || std::abs(height) > std::abs(best.height)) best.height = height;
  if (!(distance < best.distance)) return;
  best.distance = distance;
  best.y = y;
  best.normal = normal;
  best.triangle = triangle;
  std::copy(weight, weight + 3, best.weight);
}

SurfaceBalls sphere_on(const NearestPoint& p, const Vec3& centre, double r, double shell_depth) {
  SurfaceBalls out;
  const bool below = p.height < 0;
  // Behind the surface only what lies straight below it counts, not what lies past a border, nor
  // what has left the shell (on a sleeper).
  if (p.triangle < 0 || (below && p.height > -0.9 * p.distance)) return out;
  if (below && p.distance > shell_depth + r) return out;
  const Vec3 up = centre - p.y;
  const bool face = p.weight[0] > 0 && p.weight[1] > 0 && p.weight[2] > 0;
  out.overlap = below ? r + p.distance : r - p.distance;
  out.reach = r;
  out.n = face || !(p.distance > 0) ? Vec3(-p.normal) : Vec3((below ? up : -up) / p.distance);
  out.y = p.y;
  out.triangle = p.triangle;
  std::copy(p.weight, p.weight + 3, out.weight);
  return out;
}

void try_core(const PartView& part, const Mat3& R, const SurfacePatch& patch, int triangle,
              const Vec3& offset, const Corners& t, const Vec3& start, SurfaceBalls& best) {
  ShellCell solid;
  make_shell_cell(patch, 3 * triangle, offset, solid);
  PartView flat;
  flat.core = solid.view;
  Vec3 axis = -t.normal();
  const DeepestBalls d =
      deepest_balls(part, R, flat, {Mat3::Identity(), solid.origin}, start, axis);
  if (d.overlap <= best.overlap) return;
  best.overlap = d.overlap;
  best.reach = d.ra;
  best.n = d.n;
  best.y = closest_on_triangle(d.y, t.p[0], t.p[1], t.p[2], best.weight);
  best.triangle = triangle;
}

/// False: deeper in the surface than its shell reaches, or with its core.
template <class Law, bool friction>
bool evaluate_contact(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                      const StepContext& c, const std::vector<double>& travel,
                      const SurfacePatch& patch, PatchContacts& k, int i) {
  const int g = k.grain[i], first = k.first[i];
  const PartView& part = shapes.part(b.shape[g], k.part[i]);
  k.viscous_loss[i] = 0;
  if (travel[g] + k.node_travel < k.wake[first]) {
    k.friction_loss[i] = 0;
    return true;
  }
  SurfaceBalls best;
  NearestPoint nearest;
  const bool point = part.kind == Core::point;
  const Vec3 centre = point ? Vec3(b.R[g] * part.centre) : Vec3(Vec3::Zero());
  for (int e = first; e < k.first[i + 1]; ++e) {
    const Vec3 offset = k.shift[e] - b.x[g];
    const int triangle = k.triangle[e];
    const Corners t(patch, triangle, offset);
    if (point)
      try_point(centre, t, triangle, nearest);
    else
      try_core(part, b.R[g], patch, triangle, offset, t, k.arm[i], best);
  }
  if (point) best = sphere_on(nearest, centre, part.radius, patch.shell_depth);
  std::vector<std::pair<int, Vec3>>& nodal = k.nodal[i];
  nodal.clear();
  if (best.triangle < 0 || !(best.overlap > 0)) {
    if (best.triangle >= 0) k.wake[first] = travel[g] + k.node_travel - best.overlap;
    release(k, i);
    return true;
  }
  if (best.overlap > (point ? best.reach + patch.shell_depth : best.reach)) return false;

  const auto& nodes = patch.triangle[best.triangle];
  Vec3 velocity = Vec3::Zero();
  for (int j = 0; j < 3; ++j) velocity += best.weight[j] * patch.velocity[nodes[j]];
  const Vec3 zero = Vec3::Zero(), arm = best.y, old_arm = k.touching[i] ? k.arm[i] : arm;
  ContactSlip slip{zero, zero};
  if (c.dt > 0)
    slip = contact_slip(c.dt, b.v[g], b.turn[g], old_arm, arm, velocity, zero, zero, zero);
  const double way = best.n.dot(slip.displacement);
  const PairMaterial& material = materials(b.material[g], patch.material);
  const BallContactOf<double> contact{best.overlap, part.radius, c.dt > 0 ? way / c.dt : 0,
                                      b.mass[g], c.dt};
  const double force = respond<Law, friction>(material, contact, best.n, slip, k, i);
  for (int j = 0; j < 3; ++j) nodal.push_back({nodes[j], -best.weight[j] * k.force[i]});
  k.arm[i] = arm;
  k.point[i] = b.x[g] + arm;
  k.torque[i] = arm.cross(k.force[i]);
  k.tilt_stiffness[i] = part.crown > 0 ? force / part.crown : 0;
  return true;
}

template <class Law, bool friction>
void evaluate(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
              const StepContext& c, const std::vector<double>& travel, const SurfacePatch& patch,
              PatchContacts& k) {
  int through = k.size();  // first contact of a grain that is too deep
#pragma omp parallel for schedule(dynamic, 4) num_threads(c.threads) \
    reduction(min                                                    \
              : through) if (c.threads > 1)
  for (int i = k.round; i < k.size(); ++i)
    if (!evaluate_contact<Law, friction>(b, shapes, materials, c, travel, patch, k, i))
      through = std::min(through, i);
  if (through < k.size())
    throw RunError("grain " + std::to_string(k.grain[through]) + " goes deeper into surface '" +
                   patch.name + "' than its contact can follow: the contact is too soft for its " +
                   "load, or the grain too fast");
}

template <class Law>
EvaluatePatch instance(bool friction) {
  return friction ? &evaluate<Law, true> : &evaluate<Law, false>;
}

}  // namespace

EvaluatePatch make_round_patch_forces(const std::string& law, bool friction) {
  if (law == HertzMindlinLaw::name || law == HertzFlatLaw::name)
    return instance<HertzMindlinLaw>(friction);
  if (law == Sun2015Law::name) return instance<Sun2015Law>(friction);
  if (law == LinearLaw::name) return instance<LinearLaw>(friction);
  throw InputError("contact law '" + law + "': round grains on surfaces have " +
                   HertzMindlinLaw::name + ", " + HertzFlatLaw::name + ", " + Sun2015Law::name +
                   ", " + LinearLaw::name);
}

}  // namespace trackbed::dem
