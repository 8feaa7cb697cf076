// Pictures of the bed in time: snapshots.h5 with snapshots.xdmf for ParaView, and VTU files of the
// structures.
//
// snapshots.h5: mesh_<k>/triangles (corner indices into the points), mesh_<k>/triangle_grain; a
// group per snapshot, snapshot_0000 ..., with attributes time_s, stage, mesh, load_N and datasets
// points, triangle_force, grain_position, grain_velocity, grain_coordination, grain_force,
// contact_point, contact_force (on the first body), contact_grains (an index from the number of
// grains on is a rigid body, -1-k deforming surface k), rigid_points, rigid_triangles.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// What a checkpoint keeps of the snapshots written so far.
struct SnapshotLog {
  int count = 0, meshes = 0, mesh_grains = -1;
  std::vector<double> times;
  std::vector<int> mesh_of;
  std::vector<int> points_of;     ///< number of points
  std::vector<int> triangles_of;  ///< number of triangles
};

/// Appends a snapshot; the XDMF index is rewritten aside and renamed. With `fields` the structures'
/// deformation too. Throws RunError naming the file.
void write_snapshot(const Run&, const Stage&, const std::string& folder, bool fields, SnapshotLog&);

}  // namespace trackbed::apps
