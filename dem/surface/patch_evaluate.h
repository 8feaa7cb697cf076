// The loop over grains and one patch for one law, with or without friction. Included by the files
// that make the instances, nowhere else.
#pragma once
#include <omp.h>

#include <limits>

#include "dem/contact/friction.h"
#include "dem/contact/pressure.h"
#include "dem/surface/patch_forces.h"
#include "dem/surface/shell_cell.h"

namespace trackbed::dem {

/// Marks a cell entry that overlapped the grain at the last evaluation (PatchContacts::wake).
inline constexpr double kReached = -1;

inline Vec3 lowest_vertex(const ConvexView& v, const Pose& pose, const Vec3& up) {
  const Vec3 body_up = pose.R.transpose() * up;
  Vec3 lowest = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < v.vertices; ++k) {
    const Vec3 p(v.x[k], v.y[k], v.z[k]);
    if (p.dot(body_up) < least) least = p.dot(body_up), lowest = p;
  }
  return pose.x + pose.R * lowest;
}

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
  for (auto* v :
       {&k.friction_stiffness, &k.energy, &k.friction_energy, &k.area, &k.depth, &k.stiffness})
    (*v)[i] = 0;
}

/// Clips the grain of contact i against the cells it reaches. False: none.
inline bool clip_cells(const Bodies& b, const ConvexView& grain, const Pose& pose,
                       const SurfacePatch& patch, double travel, OverlapWorkspace& work,
                       PatchContacts& k, int i, ContactFrame& frame, OverlapMoments& moments,
                       std::vector<SurfacePiece>& pieces) {
  bool any = false, framed = false;
  (void)b;
  for (int e = k.first[i]; e < k.first[i + 1]; ++e) {
    if (travel + k.node_travel < k.wake[e]) continue;
    ShellCell cell;
    make_shell_cell(patch, k.cell[e], k.shift[e], cell);
    const Pose cell_pose{Mat3::Identity(), cell.origin};
    if (k.wake[e] != kReached) {
      const double gap = separating_axis(grain, pose, cell.view, cell_pose, k.axis[e]);
      if (gap > 0) {
        k.wake[e] = travel + k.node_travel + gap;
        continue;
      }
    }
    const int triangle = k.cell[e] / 3;
    if (!framed) {
      const Vec3 normal = triangle_normal(patch, triangle);
      frame = surface_frame(lowest_vertex(grain, pose, normal), normal);
      framed = true;
    }
    const std::size_t before = work.b_pieces.size();
    if (!overlap(grain, pose, cell.view, cell_pose, frame, work, moments)) {
      k.wake[e] = 0;
      continue;
    }
    k.wake[e] = kReached;
    any = true;
    for (std::size_t p = before; p < work.b_pieces.size(); ++p)
      if (work.b_pieces[p].face == cell.outer_face)
        pieces.push_back({static_cast<int>(p), triangle, k.shift[e]});
  }
  return any;
}

template <class Law, bool friction>
void evaluate_patch_contact(const Bodies& b, const ShapeTable& shapes,
                            const PairMaterials& materials, const StepContext& c,
                            const std::vector<double>& travel, const SurfacePatch& patch,
                            OverlapWorkspace& work, std::vector<SurfacePiece>& pieces,
                            PatchContacts& k, int i) {
  const int g = k.grain[i];
  const ConvexView grain = shapes.view(b.shape[g]);
  const Pose pose{b.R[g], b.x[g]};
  work.clear();
  pieces.clear();
  k.nodal[i].clear();
  ContactFrame frame;
  OverlapMoments moments;
  if (!clip_cells(b, grain, pose, patch, travel[g], work, k, i, frame, moments, pieces))
    return release(k, i);

  const PairMaterial& material = materials(b.material[g], patch.material);
  const OverlapShape shape = make_shape(moments, work);
  const NormalResponse response = Law()(shape, material);

  // Nodal forces of the pressure; what they sum to acts on the grain. Surface area per node, for
  // friction.
  Vec3 normal = Vec3::Zero(), area = Vec3::Zero();
  double total = 0;
  std::vector<std::pair<int, Vec3>>& nodal = k.nodal[i];
  static thread_local std::vector<double> share;
  share.clear();
  for (const SurfacePiece& s : pieces) {
    const auto& t = patch.triangle[s.triangle];
    Vec3 corner[3];
    for (int j = 0; j < 3; ++j)
      corner[j] = frame.axes.transpose() * (patch.node[t[j]] + s.shift - frame.origin);
    const OverlapPiece& piece = work.b_pieces[s.piece];
    const NodalForces f = nodal_pressure(work, piece, shape, response, corner);
    for (int j = 0; j < 3; ++j) {
      nodal.push_back({t[j], -(frame.axes * f.f[j])});
      share.push_back(f.share[j]);
      total += f.share[j];
      normal -= nodal.back().second;
    }
    area += piece.area;
  }
  if (!(total > 0)) {  // inside the shell only: deeper than it reaches
    nodal.clear();
    return release(k, i);
  }

  // Where the surface is touched, and how that point moves: the nodes' mean by area.
  Vec3 point = Vec3::Zero(), velocity = Vec3::Zero();
  for (std::size_t j = 0; j < nodal.size(); ++j) {
    const Vec3 shift = pieces[j / 3].shift;
    point += share[j] / total * (patch.node[nodal[j].first] + shift - b.x[g]);
    velocity += share[j] / total * patch.velocity[nodal[j].first];
  }
  const double size = normal.norm();
  const Vec3 arm = point;

  Vec3 force = normal;
  if constexpr (friction) {
    FrictionResult result;
    if (size > 0) {
      const Vec3 zero = Vec3::Zero(), old_arm = k.touching[i] ? k.arm[i] : arm;
      ContactSlip slip{zero, zero};
      if (c.dt > 0)
        slip = contact_slip(c.dt, b.v[g], b.turn[g], old_arm, arm, velocity, zero, zero, zero);
      result = advance_friction(material, normal / size, size, area.norm(), slip, k.friction[i],
                                k.friction_stiffness[i]);
      force += k.friction[i];
      for (std::size_t j = 0; j < nodal.size(); ++j)
        nodal[j].second -= share[j] / total * k.friction[i];
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
  k.area[i] = area.norm();
  k.depth[i] = shape.depth;
  k.stiffness[i] = response.stiffness;
}

template <class Law, bool friction>
void evaluate_patch(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel,
                    const SurfacePatch& patch, PatchContacts& k) {
  if (static_cast<int>(k.workspaces.size()) < c.threads) k.workspaces.resize(c.threads);
#pragma omp parallel for schedule(dynamic, 4) num_threads(c.threads) if (c.threads > 1)
  for (int i = 0; i < k.size(); ++i) {
    static thread_local std::vector<SurfacePiece> pieces;
    evaluate_patch_contact<Law, friction>(b, shapes, materials, c, travel, patch,
                                          k.workspaces[omp_get_thread_num()], pieces, k, i);
  }
}

}  // namespace trackbed::dem
