// The pair loop for one law, with or without friction. Included by the files that make the
// instances, nowhere else.
#pragma once
#include <algorithm>

#include "dem/contact/friction.h"
#include "dem/contact/normal_contact.h"
#include "dem/contact/overlap_feature.h"
#include "dem/contact/pair_fetch.h"
#include "dem/contact/pair_forces.h"
#include "dem/contact/release.h"
#include "dem/contact/shares.h"
#include "dem/contact/simple_contact.h"

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

template <class Law>
void normal_contact(const SimpleContact& s, const PairMaterial& material, NormalContact& c) {
  c.shape = s.shape;
  c.response = Law()(s.shape, material);
  set_force(integrate_pressure(s.corner, s.corners, s.shape, c.response), s.of_a ? -1 : 1, s.frame,
            c);
}

/// From the overlap in `work`, as clipped. `axis` and the overlap are made anew where the law asks
/// for it; false when they are gone then.
template <class Law, class Clip>
bool normal_contact(const OverlapMoments& moments, const ContactFrame& frame,
                    const OverlapWorkspace& work, const PairMaterial& material, Clip&& clip,
                    Vec3& axis, NormalContact& c) {
  c.shape = make_shape(moments, work);
  if constexpr (!Law::stores_energy) {
    // Depth and force are along the frame's normal: it must be that of this overlap's vector area.
    const Vec3& area = c.shape.area;
    if (area.head<2>().squaredNorm() > kFrameTurn * kFrameTurn * area.squaredNorm()) {
      axis = (frame.axes * area).normalized();
      if (!clip()) return false;
      c.shape = make_shape(moments, work);
    }
  }
  c.response = Law()(c.shape, material);
  set_force(integrate_pressure(work, work.a_pieces, c.shape, c.response), -1, frame, c);
  return true;
}

template <class Law, bool friction>
void evaluate_pair(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                   const StepContext& c, const std::vector<double>& travel, OverlapWorkspace& work,
                   Pairs& pairs, int p) {
  const int i = pairs.a[p], j = pairs.b[p];
  const ConvexView &va = shapes.part(b.shape[i], pairs.part_a[p]).core,
                   &vb = shapes.part(b.shape[j], pairs.part_b[p]).core;
  const Pose pa{b.R[i], b.x[i]};
  const Pose pb{b.R[j], b.x[j] + nearest_image(b.x[i], b.x[j], c.period)};
  const PairMaterial& material = materials(b.material[i], b.material[j]);

  // Touching pairs go straight to what their overlap was made of, then to the overlap with their
  // last normal.
  Vec3& axis = pairs.axis[p];
  NormalContact contact;
  OverlapFeature feature{pairs.feature[p], pairs.faces_a[p], pairs.faces_b[p]};
  SimpleContact simple;
  if (feature.code && simple_contact(va, pa, vb, pb, SimpleFeature::of(feature.code), simple)) {
    normal_contact<Law>(simple, material, contact);
  } else {
    OverlapMoments moments;
    ContactFrame frame;
    const auto overlaps_in_frame = [&] {
      work.clear();
      moments = OverlapMoments();
      return overlap(va, pa, vb, pb, frame, work, moments);
    };
    const auto overlaps = [&] {
      frame = contact_frame(va, pa, vb, pb, axis);
      return overlaps_in_frame();
    };
    const auto overlaps_along_axis = [&] {  // not along the face's normal nearest to it
      frame.axes = axes_along(axis);
      return overlaps_in_frame();
    };
    const auto overlaps_again = [&] {
      frame = {pa.x + pairs.arm_a[p], axes_along(axis)};
      work.clear();
      return overlap_again(va, pa, vb, pb, frame, feature, work, moments);
    };
    if (!(feature.faces_a && overlaps_again()) && !(pairs.touching[p] && overlaps())) {
      const double gap = separating_axis(va, pa, vb, pb, axis);
      if (gap > 0) sleep(travel, gap, pairs, p);
      if (gap > 0 || !overlaps()) return release(pairs, p);
    }
    if (!normal_contact<Law>(moments, frame, work, material, overlaps_along_axis, axis, contact))
      return release(pairs, p);
    feature = work.feature;
  }

  const Vec3& normal = contact.force;
  const double size = normal.norm(), area = contact.shape.area.norm();
  const Vec3 arm_a = contact.centroid - pa.x, arm_b = contact.centroid - pb.x;
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
  pairs.feature[p] = feature.code;
  pairs.faces_a[p] = feature.faces_a;
  pairs.faces_b[p] = feature.faces_b;
  pairs.arm_a[p] = arm_a;
  pairs.arm_b[p] = arm_b;
  pairs.force[p] = force;
  pairs.couple[p] = contact.couple;
  pairs.normal_force[p] = size;
  pairs.energy[p] = contact.response.energy;
  pairs.area[p] = area;
  pairs.depth[p] = contact.shape.depth;
  pairs.stiffness[p] = contact.response.stiffness;
  pairs.tilt_stiffness[p] = tilt_stiffness(contact.shape, contact.response.stiffness);
}

template <class Law, bool friction>
void evaluate_pairs(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel, Pairs& pairs) {
  if (static_cast<int>(pairs.workspaces.size()) < c.threads) pairs.workspaces.resize(c.threads);
  const int all = pairs.end(PairKind::polyhedra);
  const bool many = all > kManyPairs;
  // Of a thread at a time. The next pair beyond may be another's, so that nothing of it is asked
  // for: few beginnings where memory is far, even shares where pairs are few.
  constexpr int most = 256, kEntriesAhead = 16;
  const int share = many ? most : 32;
  const auto shares = [share](int n) { return (n + share - 1) / share; };
  by_shares(shares(all), shares(pairs.busy_end(PairKind::polyhedra)), c.threads, [&](int s, int t) {
    int awake[most], count = 0;
    for (int p = s * share; p < std::min(all, (s + 1) * share); ++p)
      if (!asleep(travel, pairs, p)) awake[count++] = p;
    for (int k = 0; k < count; ++k) {
      if (many && awake[k] + kEntriesAhead < all) fetch_entries(pairs, awake[k] + kEntriesAhead);
      if (k + 3 < count) fetch_bodies(b, shapes, pairs, awake[k + 3]);
      if (k + 2 < count) fetch_shapes(b, shapes, pairs, awake[k + 2]);
      evaluate_pair<Law, friction>(b, shapes, materials, c, travel, pairs.workspaces[t], pairs,
                                   awake[k]);
    }
  });
}

/// The two instances of a law.
template <class Law>
PairForces pair_forces_of(bool friction) {
  return {Law::name, Law::stores_energy, friction,
          friction ? &evaluate_pairs<Law, true> : &evaluate_pairs<Law, false>};
}

}  // namespace trackbed::dem
