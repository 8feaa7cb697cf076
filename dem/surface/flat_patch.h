// The flat faces of a dilated polyhedron on a deforming surface: the prisms that stand on its faces
// (contact/face_prism.h) cut with what lies behind the facets, as plain polyhedra are
// (patch_forces.h), and pressed on by the same law as between grains (contact/flat_contact.h).
#pragma once
#include "dem/contact/laws/stored_energy.h"
#include "dem/surface/patch_evaluate.h"
#include "dem/surface/surface_balls.h"

namespace trackbed::dem {

/// Behind a facet's column the surface may have been met at a neighbour, aside by some times the
/// depth: sides of columns lean by 45 degrees at a right-angled edge, more at sharper ones.
inline constexpr double kAside = 10;

/// Cuts the prisms of the part with the triangles, which know their overlaps where these are more
/// than -kAside thickness; `thickness`: no point of the grain is deeper behind the surface [m]. A
/// point of the prism on a face with normal m is nearer to a facet than the core by r n.m at most, n
/// into the facet: only faces with r n.m > h are looked at, h the core's height over the facet.
/// `framed`: in the frame that the result has. False: nothing overlaps.
bool cut_flats(const PartView&, const Pose&, const SurfacePatch&, const std::vector<NearTriangle>&,
               double thickness, OverlapWorkspace&, FacetOverlaps&, bool framed = false);

/// What the flat parts answer with, before friction.
struct FlatPressure {
  OverlapShape shape;
  NormalResponse response;
  Vec3 on_grain = Vec3::Zero();             ///< [N]
  std::vector<std::pair<int, Vec3>> nodal;  ///< node, force on it [N]
  std::vector<double> share;                ///< of each in the flats' point, their sum is 1
  std::vector<Vec3> arm;                    ///< of each, from the grain's centre [m]
  bool through = false;                     ///< deeper than the shell reaches
  FacetOverlaps cut;                        ///< scratch
};

/// Of a grain's part at x whose deepest balls are these. False: no flat parts overlap.
bool press_flats(const PartView&, const Pose&, const PairMaterial&, const SurfacePatch&,
                 const std::vector<NearTriangle>&, const SurfaceBalls&, OverlapWorkspace&,
                 FlatPressure&);

}  // namespace trackbed::dem
