#include "dem/surface/round_patch.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dem/contact/flat_response.h"
#include "dem/contact/laws/hertz_flat.h"
#include "dem/contact/laws/hertz_mindlin.h"
#include "dem/contact/laws/linear.h"
#include "dem/contact/laws/sun2015.h"
#include "dem/contact/shares.h"
#include "dem/surface/flat_patch.h"
#include "dem/surface/surface_balls.h"

namespace trackbed::dem {
namespace {

const Vec3 kZero = Vec3::Zero();

ContactSlip slip_of(const Bodies& b, const StepContext& c, const PatchContacts& k, int i,
                    const Vec3& arm, const Vec3& velocity) {
  if (!(c.dt > 0)) return {kZero, kZero};
  const int g = k.grain[i];
  return contact_slip(c.dt, b.v[g], b.turn[g], k.touching[i] ? k.arm[i] : arm, arm, velocity, kZero,
                      kZero, kZero);
}

/// The balls alone.
template <class Law, bool friction>
void respond_balls(const Bodies& b, const PartView& part, const PairMaterial& material,
                   const StepContext& c, const SurfacePatch& patch, const SurfaceBalls& balls,
                   PatchContacts& k, int i) {
  const auto& nodes = patch.triangle[balls.on.triangle];
  const int g = k.grain[i];
  Vec3 velocity = kZero;
  for (int j = 0; j < 3; ++j) velocity += balls.weight[j] * patch.velocity[nodes[j]];
  const Vec3& arm = balls.y;
  const ContactSlip slip = slip_of(b, c, k, i, arm, velocity);
  const double way = balls.n.dot(slip.displacement);
  const BallContactOf<double> contact{balls.overlap, part.radius, c.dt > 0 ? way / c.dt : 0,
                                      b.mass[g], c.dt};
  const double force = respond<Law, friction>(material, contact, balls.n, slip, k, i);
  for (int j = 0; j < 3; ++j) k.nodal[i].push_back({nodes[j], -balls.weight[j] * k.force[i]});
  k.arm[i] = arm;
  k.point[i] = b.x[g] + arm;
  k.torque[i] = arm.cross(k.force[i]);
  k.tilt_stiffness[i] = part.crown > 0 ? force / part.crown : 0;
}

/// Balls and flat parts together, as respond_flat() between grains: each presses on its own nodes,
/// friction and damping on all of them by their share in one point between the two.
template <class Law, bool friction>
void respond_flats(const Bodies& b, const PartView& part, const PairMaterial& material,
                   const StepContext& c, const SurfacePatch& patch, const SurfaceBalls& balls,
                   FlatPressure& flat, PatchContacts& k, int i) {
  const int g = k.grain[i];
  const BallContactOf<double> contact{balls.overlap, part.radius, 0, b.mass[g], c.dt};
  const BallsAndFlats sum = balls_and_flats<Law>(material, contact, balls.n, flat.on_grain);
  for (double& s : flat.share) s *= sum.share;
  const auto& nodes = patch.triangle[balls.on.triangle];
  for (int j = 0; j < 3; ++j) {
    flat.nodal.push_back({nodes[j], -balls.weight[j] * sum.of_balls});
    flat.share.push_back((1 - sum.share) * balls.weight[j]);
    flat.arm.push_back(patch.node[nodes[j]] + balls.on.shift - b.x[g]);
  }
  Vec3 arm = kZero, velocity = kZero;
  for (std::size_t j = 0; j < flat.nodal.size(); ++j) {
    arm += flat.share[j] * flat.arm[j];
    velocity += flat.share[j] * patch.velocity[flat.nodal[j].first];
  }
  const double force = advance_balls_and_flats<friction>(
      material, contact, sum, flat.shape, flat.response, flat.shape.area.norm(), part.crown,
      slip_of(b, c, k, i, arm, velocity), k, i);
  k.normal_force[i] = -force * sum.direction;
  k.force[i] = k.normal_force[i];
  if constexpr (friction) k.force[i] += k.friction[i];
  const Vec3 more = k.force[i] - sum.elastic;  // of damping and friction
  k.torque[i].setZero();
  for (std::size_t j = 0; j < flat.nodal.size(); ++j) {
    const Vec3 on_node = flat.nodal[j].second - flat.share[j] * more;
    k.nodal[i].push_back({flat.nodal[j].first, on_node});
    k.torque[i] -= flat.arm[j].cross(on_node);
  }
  k.arm[i] = arm;
  k.point[i] = b.x[g] + arm;
}

/// The part as the law sees it: with flat faces or crowned ones.
template <class Law>
const PartView& part_of(const ShapeTable& shapes, int shape, int k) {
  return Law::flats ? shapes.flat_part(shape, k) : shapes.part(shape, k);
}

/// By how much the part may overlap triangle e at most [m]: the last look's overlap and what both
/// travelled since. Of one never looked at, as if the part were its bounding ball; what lies behind
/// a triangle is as near as its inner nodes are deep.
double most_overlap(const PartView& part, const Vec3& x, const SurfacePatch& patch, double now,
                    const PatchContacts& k, int e) {
  if (k.wake[e] != 0) return now - k.wake[e];
  Vec3 corner[3];
  double weight[3], deep = 0;
  for (int j = 0; j < 3; ++j) {
    const int node = patch.triangle[k.triangle[e]][j];
    corner[j] = patch.node[node] + k.shift[e] - x;
    deep = std::max(deep, patch.inset[node].norm());
  }
  const Vec3 nearest = closest_on_triangle(Vec3::Zero(), corner[0], corner[1], corner[2], weight);
  return part.core.radius + part.radius + part.crown / 2 * part.mean_square + deep - nearest.norm();
}

/// Where the part is deepest. Tells each triangle, or the first for all, how long it is apart.
template <class Law>
SurfaceBalls find_balls(const Bodies& b, const PartView& part, const SurfacePatch& patch,
                        double now, std::vector<NearTriangle>& near, PatchContacts& k, int i) {
  const int g = k.grain[i], first = k.first[i], last = k.first[i + 1];
  near.clear();
  for (int e = first; e < last; ++e) near.push_back({k.triangle[e], k.shift[e]});
  if (part.kind == Core::point) {
    const SurfaceBalls best =
        sphere_on_surface(b.x[g], b.R[g] * part.centre, part.radius, patch, near);
    if (best.on.triangle >= 0 && !(best.overlap > 0)) k.wake[first] = now - best.overlap;
    return best;
  }
  for (int e = first; e < last; ++e)
    near[e - first].overlap = most_overlap(part, b.x[g], patch, now, k, e);
  const SurfaceBalls best =
      core_on_surface(part, b.x[g], b.R[g], k.arm[i], patch, Law::flats ? kAside : 0, near);
  for (int e = first; e < last; ++e)
    if (near[e - first].exact || k.wake[e] == 0) k.wake[e] = now - near[e - first].overlap;
  return best;
}

/// False: deeper in the surface than its shell reaches, or with its core.
template <class Law, bool friction>
bool evaluate_contact(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                      const StepContext& c, const std::vector<double>& travel,
                      const SurfacePatch& patch, OverlapWorkspace& work, PatchContacts& k, int i) {
  const int g = k.grain[i];
  const PartView& part = part_of<Law>(shapes, b.shape[g], k.part[i]);
  const bool point = part.kind == Core::point;
  k.viscous_loss[i] = 0;
  const double now = travel[g] + k.node_travel;
  const auto apart = [now](double wake) { return now < wake; };
  const double* wake = k.wake.data() + k.first[i];
  if (std::all_of(wake, point ? wake + 1 : k.wake.data() + k.first[i + 1], apart)) {
    k.friction_loss[i] = 0;
    return true;
  }
  static thread_local std::vector<NearTriangle> near;
  const SurfaceBalls best = find_balls<Law>(b, part, patch, now, near, k, i);
  k.nodal[i].clear();
  if (best.on.triangle < 0 || !(best.overlap > 0)) {
    release(k, i);
    return true;
  }
  if (best.overlap > (point ? best.reach + patch.shell_depth : best.reach)) return false;
  const PairMaterial& material = materials(b.material[g], patch.material);
  if constexpr (Law::flats) {
    static thread_local FlatPressure flat;
    if (!point && press_flats(part, {b.R[g], b.x[g]}, material, patch, near, best, work, flat)) {
      respond_flats<Law, friction>(b, part, material, c, patch, best, flat, k, i);
      return !flat.through;
    }
  }
  respond_balls<Law, friction>(b, part, material, c, patch, best, k, i);
  return true;
}

template <class Law, bool friction>
void evaluate(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
              const StepContext& c, const std::vector<double>& travel, const SurfacePatch& patch,
              PatchContacts& k) {
  if (static_cast<int>(k.workspaces.size()) < c.threads) k.workspaces.resize(c.threads);
  std::atomic<int> through = k.size();  // first contact of a grain that is too deep
  constexpr int share = 4;
  const int shares = (k.size() - k.round + share - 1) / share;
  by_shares(shares, shares, c.threads, [&](int s, int t) {
    const int first = k.round + s * share;
    for (int i = first; i < std::min(k.size(), first + share); ++i)
      if (!evaluate_contact<Law, friction>(b, shapes, materials, c, travel, patch, k.workspaces[t],
                                           k, i))
        lower_to(i, through);
  });
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
  if (law == HertzMindlinLaw::name) return instance<HertzMindlinLaw>(friction);
  if (law == HertzFlatLaw::name) return instance<HertzFlatLaw>(friction);
  if (law == Sun2015Law::name) return instance<Sun2015Law>(friction);
  if (law == LinearLaw::name) return instance<LinearLaw>(friction);
  throw InputError("contact law '" + law + "': round grains on surfaces have " +
                   HertzMindlinLaw::name + ", " + HertzFlatLaw::name + ", " + Sun2015Law::name +
                   ", " + LinearLaw::name);
}

}  // namespace trackbed::dem
