// The loop over grains and one patch for one law, with or without friction. Included by the files
// that make the instances, nowhere else.
#pragma once

#include <algorithm>
#include <limits>

#include "base/error.h"
#include "dem/contact/fetch.h"
#include "dem/contact/friction.h"
#include "dem/contact/pair_evaluate.h"
#include "dem/contact/pressure.h"
#include "dem/contact/shares.h"
#include "dem/surface/facet_cut.h"
#include "dem/surface/patch_forces.h"
#include "dem/surface/shell_cell.h"

namespace trackbed::dem {

/// Marks a facet entry that overlapped the grain at the last evaluation (PatchContacts::wake).
inline constexpr double kReached = -1;

/// Frame with third axis -normal: from the grain into the surface.
inline ContactFrame surface_frame(const Vec3& origin, const Vec3& normal) {
  ContactFrame frame;
  frame.origin = origin;
  frame.axes.col(2) = -normal;
  frame.axes.col(0) = frame.axes.col(2).unitOrthogonal();
  frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
  return frame;
}

/// A piece of the surface inside the grain: `piece` of the workspace, on `triangle`.
struct SurfacePiece {
  int piece, triangle;
  Vec3 shift;
};

inline void release(PatchContacts& k, int i) {
  if (!k.touching[i] && k.friction_loss[i] == 0) return;
  k.touching[i] = 0;
  k.friction_loss[i] = k.friction_energy[i];
  for (auto* v : {&k.friction, &k.force, &k.torque, &k.normal_force}) (*v)[i].setZero();
  for (auto* v : {&k.friction_stiffness, &k.energy, &k.friction_energy, &k.area, &k.depth,
                  &k.stiffness, &k.tilt_stiffness, &k.viscous})
    (*v)[i] = 0;
}

/// Adds the moments of one cell or facet, taken about a point of its own: where a grain's face lies
/// in a cell's side, the pieces of that (empty) overlap do not close, and only about a point in
/// their plane are they worth nothing.
inline void add_moments(const OverlapMoments& cell, OverlapMoments& sum) {
  if (!(sum.volume > 0)) {
    sum = cell;
    return;
  }
  const Vec3 d = cell.about - sum.about;
  sum.volume += cell.volume;
  sum.first += cell.first + cell.volume * d;
  sum.second += cell.second + cell.first * d.transpose() + d * cell.first.transpose() +
                cell.volume * d * d.transpose();
}

/// What cutting a grain with its facets leaves besides the workspace's pieces.
struct FacetOverlaps {
  ContactFrame frame;
  OverlapMoments moments;
  std::vector<SurfacePiece> pieces;  ///< on the surface
  bool through = false;              ///< the grain reaches past the bottom of the shell
};

/// Clips the grain against the three cells behind a triangle; true if it overlaps one.
inline bool clip_cells(const ConvexView& grain, const Pose& pose, const SurfacePatch& patch,
                       int triangle, const Vec3& shift, OverlapWorkspace& work,
                       FacetOverlaps& out) {
  bool any = false;
  for (int k = 3 * triangle; k < 3 * triangle + 3; ++k) {
    ShellCell cell;
    make_shell_cell(patch, k, shift, cell);
    const std::size_t before = work.b_pieces.size();
    OverlapMoments moments;
    if (!overlap(grain, pose, cell.view, {Mat3::Identity(), cell.origin}, out.frame, work, moments))
      continue;
    any = true;
    add_moments(moments, out.moments);
    for (std::size_t p = before; p < work.b_pieces.size(); ++p) {
      if (work.b_pieces[p].face == cell.outer_face)
        out.pieces.push_back({static_cast<int>(p), triangle, shift});
      if (work.b_pieces[p].face == cell.inner_face) out.through = true;
    }
  }
  return any;
}

/// The same by the facet as a whole where that can be.
inline bool cut_facet(const ConvexView& grain, const Pose& pose, const SurfacePatch& patch,
                      const Facet& facet, int triangle, const Vec3& shift, bool framed,
                      OverlapWorkspace& work, FacetOverlaps& out) {
  GrainBelow at;
  const bool small = find_below(grain, pose, facet, at);
  const int before = static_cast<int>(work.b_pieces.size());
  OverlapMoments moments;
  FacetOverlap found = FacetOverlap::not_for_one_facet;
  if (small && !framed && vertex_behind_facet(grain, pose, facet, at, out.frame, work, moments)) {
    found = FacetOverlap::cut;
  } else {
    if (!framed) {
      const int v = at.lowest_vertex;
      out.frame =
          surface_frame(pose.x + pose.R * Vec3(grain.x[v], grain.y[v], grain.z[v]), facet.normal);
    }
    if (small) found = cut_behind_facet(grain, pose, facet, at, out.frame, work, moments);
  }
  if (found == FacetOverlap::none) return false;
  if (found == FacetOverlap::cut) {
    add_moments(moments, out.moments);
    for (int p = before; p < static_cast<int>(work.b_pieces.size()); ++p)
      out.pieces.push_back({p, triangle, shift});
    return true;
  }
  return clip_cells(grain, pose, patch, triangle, shift, work, out);
}

/// Makes all but the frame anew.
inline void clear(OverlapWorkspace& work, FacetOverlaps& out) {
  work.clear();
  out.pieces.clear();
  out.moments = OverlapMoments();
  out.through = false;
}

/// A thin overlap keeps its digits only in a frame along its own normal. The frame is the first
/// facet's; at an edge that may be one the grain hardly reaches, while it lies flat on the other.
/// True: the frame is now along the surface's vector area, and the overlap is to be cut again.
inline bool turn_frame(const OverlapWorkspace& work, FacetOverlaps& out) {
  Vec3 area = Vec3::Zero();
  for (const SurfacePiece& s : out.pieces) area += work.b_pieces[s.piece].area;
  const double size2 = area.squaredNorm();
  if (!(size2 > 0) || area.z() * area.z() >= 0.99 * size2) return false;  // within 6 degrees
  const ContactFrame& frame = out.frame;
  out.frame = surface_frame(frame.origin + frame.axes * out.moments.about,
                            (frame.axes * area).normalized());
  return true;
}

/// Cuts the grain of contact i with the facets it reaches. False: none.
inline bool cut_facets(const ConvexView& grain, const Pose& pose, const SurfacePatch& patch,
                       double travel, OverlapWorkspace& work, PatchContacts& k, int i,
                       FacetOverlaps& out, bool framed = false) {
  const bool again = framed;
  clear(work, out);
  for (int e = k.first[i]; e < k.first[i + 1]; ++e) {
    if (travel + k.node_travel < k.wake[e]) continue;
    Facet facet;
    make_facet(patch, k.triangle[e], k.shift[e], facet);
    if (k.wake[e] != kReached) {
      const double gap =
          separating_axis(grain, pose, facet.hull(), {Mat3::Identity(), facet.origin}, k.axis[e]);
      if (gap > 0) {
        k.wake[e] = travel + k.node_travel + gap;
        continue;
      }
    }
    const bool reached =
        cut_facet(grain, pose, patch, facet, k.triangle[e], k.shift[e], framed, work, out);
    k.wake[e] = reached ? kReached : 0;
    framed |= reached;
  }
  if (!again && turn_frame(work, out))
    return cut_facets(grain, pose, patch, travel, work, k, i, out, true);
  return out.moments.volume > 0;
}

/// The overlap of a grain with its facets as laws read it; `area` is minus that of the surface
/// inside the grain.
inline OverlapShape surface_shape(const FacetOverlaps& cut, const OverlapWorkspace& work) {
  OverlapShape shape = make_shape(cut.moments, work);
  shape.area.setZero();
  for (const SurfacePiece& s : cut.pieces) shape.area -= work.b_pieces[s.piece].area;
  return shape;
}

/// What a law's pressure on the surface inside a grain sums to.
struct SurfacePressure {
  Vec3 on_grain = Vec3::Zero();  ///< [N], world axes
  double area = 0;               ///< sum of the shares [m2]
};

/// Appends the pressure's nodal forces, three a piece, and their shares of the pieces' area [m2].
inline SurfacePressure press_on_surface(const FacetOverlaps& cut, const OverlapWorkspace& work,
                                        const SurfacePatch& patch, const OverlapShape& shape,
                                        const NormalResponse& response,
                                        std::vector<std::pair<int, Vec3>>& nodal,
                                        std::vector<double>& share) {
  const Mat3& axes = cut.frame.axes;
  SurfacePressure sum;
  for (const SurfacePiece& s : cut.pieces) {
    const auto& t = patch.triangle[s.triangle];
    Vec3 corner[3];
    for (int j = 0; j < 3; ++j)
      corner[j] = axes.transpose() * (patch.node[t[j]] + s.shift - cut.frame.origin);
    const NodalForces f = nodal_pressure(work, work.b_pieces[s.piece], shape, response, corner);
    for (int j = 0; j < 3; ++j) {
      nodal.push_back({t[j], -(axes * f.f[j])});
      share.push_back(f.share[j]);
      sum.area += f.share[j];
      sum.on_grain -= nodal.back().second;
    }
  }
  return sum;
}

/// False: the grain is deeper in the surface than its shell reaches.
template <class Law, bool friction>
bool evaluate_patch_contact(const Bodies& b, const ShapeTable& shapes,
                            const PairMaterials& materials, const StepContext& c,
                            const std::vector<double>& travel, const SurfacePatch& patch,
                            OverlapWorkspace& work, PatchContacts& k, int i) {
  const int g = k.grain[i];
  const ConvexView grain = shapes.part(b.shape[g], k.part[i]).core;
  const Pose pose{b.R[g], b.x[g]};
  static thread_local FacetOverlaps cut;
  static thread_local std::vector<double> share;  // of the surface's area, per nodal force
  std::vector<std::pair<int, Vec3>>& nodal = k.nodal[i];
  nodal.clear();
  share.clear();
  const bool touches = cut_facets(grain, pose, patch, travel[g], work, k, i, cut);
  if (!touches || cut.pieces.empty()) {
    release(k, i);
    return !cut.through && cut.moments.volume < 1e-3 * shapes.shape(b.shape[g]).volume;
  }
  const std::vector<SurfacePiece>& pieces = cut.pieces;
  const PairMaterial& material = materials(b.material[g], patch.material);
  const OverlapShape shape = surface_shape(cut, work);
  const NormalResponse response = Law()(shape, material);
  const SurfacePressure pressed = press_on_surface(cut, work, patch, shape, response, nodal, share);
  const Vec3& normal = pressed.on_grain;
  const double total = pressed.area;
  if (!(total > 0)) {
    nodal.clear();
    release(k, i);
    return true;
  }

  // Friction's point: the centroid of the surface inside the grain.
  Vec3 arm = Vec3::Zero(), velocity = Vec3::Zero();
  for (std::size_t j = 0; j < nodal.size(); ++j) {
    const int node = nodal[j].first;
    share[j] /= total;
    arm += share[j] * (patch.node[node] + pieces[j / 3].shift - b.x[g]);
    velocity += share[j] * patch.velocity[node];
  }
  const double size = normal.norm();

  Vec3 force = normal;
  if constexpr (friction) {
    FrictionResult result;
    if (size > 0) {
      const Vec3 zero = Vec3::Zero(), old_arm = k.touching[i] ? k.arm[i] : arm;
      ContactSlip slip{zero, zero};
      if (c.dt > 0)
        slip = contact_slip(c.dt, b.v[g], b.turn[g], old_arm, arm, velocity, zero, zero, zero);
      result = advance_friction(material, normal / size, size, shape.area.norm(), slip,
                                k.friction[i], k.friction_stiffness[i]);
      force += k.friction[i];
      for (std::size_t j = 0; j < nodal.size(); ++j) nodal[j].second -= share[j] * k.friction[i];
    }
    k.friction_energy[i] = result.stored;
    k.friction_loss[i] = result.dissipated;
  }

  Vec3 torque = Vec3::Zero();
  for (std::size_t j = 0; j < nodal.size(); ++j)
    torque -= (patch.node[nodal[j].first] + pieces[j / 3].shift - b.x[g]).cross(nodal[j].second);
  k.touching[i] = 1;
  k.arm[i] = arm;
  k.point[i] = b.x[g] + arm;
  k.force[i] = force;
  k.torque[i] = torque;
  k.normal_force[i] = normal;
  k.energy[i] = response.energy;
  k.area[i] = shape.area.norm();
  k.depth[i] = shape.depth;
  k.stiffness[i] = response.stiffness;
  k.tilt_stiffness[i] = tilt_stiffness(shape, response.stiffness);
  return !cut.through;
}

/// The contacts that may touch, in order: some facet of theirs is not known to be apart. Of the
/// others those that touched are released.
inline void find_awake(const std::vector<double>& travel, PatchContacts& k) {
  k.awake.clear();
  for (int i = 0; i < k.round; ++i) {
    const double now = travel[k.grain[i]] + k.node_travel;
    const auto apart = [now](double wake) { return now < wake; };
    if (std::all_of(&k.wake[k.first[i]], &k.wake[k.first[i + 1] - 1] + 1, apart))
      release(k, i);
    else
      k.awake.push_back(i);
  }
}

// What the next contacts need is asked for before, as in pair_evaluate.h: few of the bed's contacts
// are with surfaces, and the many others have pushed all of it out since the last step.
[[gnu::always_inline]] inline void fetch_contact(const Bodies& b, const ShapeTable& shapes,
                                                 const PatchContacts& k, int i) {
  const int g = k.grain[i];
  fetch(b.x[g]), fetch(b.v[g]), fetch(b.turn[g]);
  fetch_lines(&b.R[g], 2);
  fetch_lines(&shapes.part(b.shape[g], k.part[i]), 2);
  for (const auto* v : {&k.friction, &k.arm, &k.force, &k.torque, &k.normal_force, &k.point})
    fetch_lines(&(*v)[i], 1);
  for (const auto* v : {&k.friction_stiffness, &k.energy, &k.friction_energy, &k.friction_loss,
                        &k.area, &k.depth, &k.stiffness, &k.tilt_stiffness})
    fetch_lines(&(*v)[i], 1);
  fetch_lines(&k.nodal[i], 1);
}

[[gnu::always_inline]] inline void fetch_shape(const Bodies& b, const ShapeTable& shapes,
                                               const PatchContacts& k, int i) {
  const ConvexView& v = shapes.part(b.shape[k.grain[i]], k.part[i]).core;
  fetch_lines(v.x, 3 * (v.padded / 8));  // y and z follow
  fetch_lines(v.loop_begin, 1);
  fetch_lines(v.loop, 2);
  if (v.vertex_faces) fetch_lines(v.vertex_faces, (v.vertices + 7) / 8);
  fetch_lines(k.nodal[i].data(), 3);
}

template <class Law, bool friction>
void evaluate_patch(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel,
                    const SurfacePatch& patch, PatchContacts& k) {
  if (static_cast<int>(k.workspaces.size()) < c.threads) k.workspaces.resize(c.threads);
  find_awake(travel, k);
  const int awake = static_cast<int>(k.awake.size());
  std::atomic<int> through = k.round;  // first contact of a grain that the shell cannot hold
  constexpr int share = 8;             // the next contact beyond it may be another thread's
  const int shares = (awake + share - 1) / share;
  by_shares(shares, shares, c.threads, [&](int s, int t) {
    const int end = std::min(awake, (s + 1) * share);
    for (int n = s * share; n < end; ++n) {
      const int i = k.awake[n];
      if (n + 2 < end) fetch_contact(b, shapes, k, k.awake[n + 2]);
      if (n + 1 < end) fetch_shape(b, shapes, k, k.awake[n + 1]);
      if (!evaluate_patch_contact<Law, friction>(b, shapes, materials, c, travel, patch,
                                                 k.workspaces[t], k, i))
        lower_to(i, through);
    }
  });
  if (through < k.round)
    throw RunError("grain " + std::to_string(k.grain[through]) + " goes deeper into surface '" +
                   patch.name + "' than its contact shell of " +
                   std::to_string(1e3 * patch.shell_depth) +
                   " mm: the contact is too soft for its load, or the grain too fast");
}

}  // namespace trackbed::dem
