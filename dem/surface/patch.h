// A deforming surface that grains touch: a triangulated patch with a thin shell of tetrahedra
// behind it. The carrier (an FE body, a prescribed motion) moves the nodes; grains push back with
// nodal forces.
//
// One grain and one patch make ONE contact: square roots of overlap volumes do not add up over
// facets, so a law evaluated per facet would bump at every edge. The grain is clipped against the
// few shell cells it reaches, their moments are summed, and the law is evaluated once
// (surface/patch_forces.h). Convex edges belong to one patch; concave corners separate patches.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

struct SurfacePatch {
  std::string name;
  int material = 0;

  // Topology, fixed. Triangles are counter-clockwise seen from the grains.
  std::vector<std::array<int, 3>> triangle;
  std::vector<Vec3> inset;   ///< node -> inner side of the shell, constant [m]
  std::vector<int> master;   ///< node it moves with: itself, or the border node of a skirt node
  std::vector<Vec3> offset;  ///< of a skirt node from its master [m]
  int carried = 0;           ///< nodes [0, carried) belong to the carrier, the rest is skirt

  // Motion, set by the carrier each step, then move_skirt().
  std::vector<Vec3> node;      ///< position [m]
  std::vector<Vec3> velocity;  ///< mean over the step [m/s]

  // Answer of the grains: force on the carried nodes [N].
  std::vector<Vec3> force;

  double shell_depth = 0;  ///< [m]
};

/// Builds a patch from nodes [m] and outward counter-clockwise quads (each split in two triangles).
/// The shell reaches `shell_depth` behind every facet. `skirt` > 0 prolongs the patch by that width
/// beyond its border (edges of one quad only), level with the facet there, so that a grain that
/// leans on a wall above the border meets a surface that goes on; skirt nodes follow their border
/// node and hand it their force. `period` (0 = none, per direction): border edges on a seam
/// (|coordinate| = period/2) get no skirt, the patch's own image goes on there. Throws InputError
/// for a facet without area, and for a patch that is folded so sharply, or whose facets at an edge
/// are so small, that no shell fits behind it.
SurfacePatch make_patch(const std::string& name, int material, const std::vector<Vec3>& nodes,
                        const std::vector<std::array<int, 4>>& quads, double shell_depth,
                        double skirt, const Vec3& period);

/// Brings the skirt to its border nodes, after the carrier moved node [0, carried) and velocity.
void move_skirt(SurfacePatch&);

}  // namespace trackbed::dem
