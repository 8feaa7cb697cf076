// The pair loop for one law, with or without friction. Included by the files that make the
// instances, nowhere else.
#pragma once
#include <omp.h>

#include "dem/contact/friction.h"
#include "dem/contact/overlap_feature.h"
#include "dem/contact/pair_forces.h"
#include "dem/contact/pressure.h"
#include "dem/contact/release.h"

namespace trackbed::dem {

/// 9/4 k times the largest tangential radius of gyration squared: what the stored-energy law gives
/// face on face (U changes as C_zz^(3/4), C_zz by theta^2 C_xx), about a bound for other contacts.
inline double tilt_stiffness(const OverlapShape& s, double stiffness) {
  const Mat3& C = s.second_moment;
  const double mean = (C(0, 0) + C(1, 1)) / 2, half = (C(0, 0) - C(1, 1)) / 2;
  return 2.25 * stiffness * (mean + std::sqrt(half * half + C(0, 1) * C(0, 1))) / s.volume;
}

/// Angle between a frame's normal and the vector area's from which the frame is made anew [rad].
inline constexpr double kFrameTurn = 1e-10;

template <class Law, bool friction>
void evaluate_pair(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                   const StepContext& c, const std::vector<double>& travel, OverlapWorkspace& work,
                   Pairs& pairs, int p) {
  const int i = pairs.a[p], j = pairs.b[p];
  const ConvexView &va = shapes.part(b.shape[i], pairs.part_a[p]).core,
                   &vb = shapes.part(b.shape[j], pairs.part_b[p]).core;
  const Pose pa{b.R[i], b.x[i]};
  const Pose pb{b.R[j], b.x[j] + nearest_image(b.x[i], b.x[j], c.period)};

  // Touching pairs go straight to the overlap with their last normal, or what it was made of.
  Vec3& axis = pairs.axis[p];
  OverlapMoments moments;
  ContactFrame frame;
  const auto overlaps = [&] {
    frame = contact_frame(va, pa, vb, pb, axis);
    work.clear();
    moments = OverlapMoments();
    return overlap(va, pa, vb, pb, frame, work, moments);
  };
  const OverlapFeature feature{pairs.feature[p], pairs.faces_a[p], pairs.faces_b[p]};
  const auto overlaps_again = [&] {
    frame = {pa.x + pairs.arm_a[p], axes_along(axis)};
    work.clear();
    return overlap_again(va, pa, vb, pb, frame, feature, work, moments);
  };
  if (!(feature && overlaps_again()) && !(pairs.touching[p] && overlaps())) {
    const double gap = separating_axis(va, pa, vb, pb, axis);
    if (gap > 0) pairs.wake[p] = travel[i] + travel[j] + gap;
    if (gap > 0 || !overlaps()) return release(pairs, p);
  }

  const PairMaterial& material = materials(b.material[i], b.material[j]);
  OverlapShape shape = make_shape(moments, work);
  if constexpr (!Law::stores_energy) {
    // Depth and force are along the frame's normal: it must be that of this overlap's vector area.
    if (shape.area.head<2>().squaredNorm() > kFrameTurn * kFrameTurn * shape.area.squaredNorm()) {
      axis = (frame.axes * shape.area).normalized();
      if (!overlaps()) return release(pairs, p);
      shape = make_shape(moments, work);
    }
  }
  const NormalResponse response = Law()(shape, material);
  const PressureForce pressure = integrate_pressure(work, work.a_pieces, shape, response);
  const Vec3 normal = -(frame.axes * pressure.force);
  const double size = normal.norm();
  const Vec3 centroid = frame.axes * shape.centroid + frame.origin;
  const Vec3 arm_a = centroid - pa.x, arm_b = centroid - pb.x;
  const double area = shape.area.norm();
  if (size > 0) axis = -normal / size;

  Vec3 force = normal;
  if constexpr (friction) {
    const bool old = pairs.touching[p];
    ContactSlip slip{Vec3::Zero(), Vec3::Zero()};
    if (c.dt > 0)
      slip = contact_slip(c.dt, b.v[i], b.turn[i], old ? pairs.arm_a[p] : arm_a, arm_a, b.v[j],
                          b.turn[j], old ? pairs.arm_b[p] : arm_b, arm_b);
    const FrictionResult result = advance_friction(material, axis, size, area, slip,
                                                   pairs.friction[p], pairs.friction_stiffness[p]);
    force += pairs.friction[p];
    pairs.friction_energy[p] = result.stored;
    pairs.friction_loss[p] = result.dissipated;
  } else {
    pairs.friction_energy[p] = pairs.friction_loss[p] = 0;  // others may add
  }
  pairs.touching[p] = 1;
  pairs.feature[p] = work.feature.code;
  pairs.faces_a[p] = work.feature.faces_a;
  pairs.faces_b[p] = work.feature.faces_b;
  pairs.arm_a[p] = arm_a;
  pairs.arm_b[p] = arm_b;
  pairs.force[p] = force;
  pairs.couple[p] = -(frame.axes * pressure.moment);
  pairs.normal_force[p] = normal;
  pairs.energy[p] = response.energy;
  pairs.area[p] = area;
  pairs.depth[p] = shape.depth;
  pairs.stiffness[p] = response.stiffness;
  pairs.tilt_stiffness[p] = tilt_stiffness(shape, response.stiffness);
}

/// The pairs that may touch, in order; of the others, what only a step's evaluation sets.
inline void find_awake(const std::vector<double>& travel, Pairs& pairs) {
  pairs.awake.clear();
  for (int p = 0; p < pairs.end(PairKind::polyhedra); ++p) {
    if (travel[pairs.a[p]] + travel[pairs.b[p]] < pairs.wake[p])
      pairs.friction_loss[p] = 0;
    else
      pairs.awake.push_back(p);
  }
}

template <class Law, bool friction>
void evaluate_pairs(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel, Pairs& pairs) {
  if (static_cast<int>(pairs.workspaces.size()) < c.threads) pairs.workspaces.resize(c.threads);
  find_awake(travel, pairs);
  const int awake = static_cast<int>(pairs.awake.size());
#pragma omp parallel for schedule(dynamic, 32) num_threads(c.threads) if (c.threads > 1)
  for (int k = 0; k < awake; ++k)
    evaluate_pair<Law, friction>(b, shapes, materials, c, travel,
                                 pairs.workspaces[omp_get_thread_num()], pairs, pairs.awake[k]);
}

/// The two instances of a law.
template <class Law>
PairForces pair_forces_of(bool friction) {
  return {Law::name, Law::stores_energy, friction,
          friction ? &evaluate_pairs<Law, true> : &evaluate_pairs<Law, false>};
}

}  // namespace trackbed::dem
