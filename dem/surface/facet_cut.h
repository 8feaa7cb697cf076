// The overlap of a grain with what lies behind one facet of a surface, cut out plane by plane.
//
// Most grains press on the middle of a facet or on few of its edges: the overlap is the grain's cap
// below the facet's plane, cut by the sides that the cap reaches over (Sutherland & Hodgman, CACM
// 17, 1974; the hole that a cut leaves is closed by the corners it made). That is the same set as
// the overlaps with the facet's three tetrahedra (patch_forces.h) together, and the same pieces to
// rounding, at a fraction of the work: of the grain only the faces at vertices below the plane are
// looked at, of the facet the planes that cut.
//
// Left to the tetrahedra: caps that reach the shell's bottom, that a side which is no plane cuts,
// or that have more corners than the room below.
#pragma once
#include "dem/contact/overlap.h"
#include "dem/surface/facet.h"

namespace trackbed::dem {

enum class FacetOverlap { none, cut, not_for_one_facet };

/// Where a grain stands to a facet's plane.
struct GrainBelow {
  static constexpr int kMost = 64;
  alignas(64) double height[kMost];  ///< of the vertices over the plane [m]
  std::uint64_t below = 0;           ///< vertices with height < 0
  double lowest = 0;                 ///< least height; 0 where none is below [m]
  int lowest_vertex = 0;             ///< where
};

/// False for bodies of more than 64 vertices or faces: only the lowest vertex is found then.
bool find_below(const ConvexView& grain, const Pose&, const Facet&, GrainBelow&);

/// A single vertex below the plane, its edges leaving through the facet alone: the commonest case,
/// in closed form (contact/simple_contact.h). Sets `frame`; the workspace gets the facet inside the
/// grain as a piece, and the vertex as one more point. False: it is another case.
bool vertex_behind_facet(const ConvexView& grain, const Pose&, const Facet&, const GrainBelow&,
                         ContactFrame& frame, OverlapWorkspace& work, OverlapMoments&);

/// Appends the grain's faces inside the facet to work.a_pieces and the facet inside the grain to
/// work.b_pieces, as face 0, in frame coordinates, and sets the moments about a point of their own.
/// The frame's third axis should be near the facet's normal, either sense.
FacetOverlap cut_behind_facet(const ConvexView& grain, const Pose&, const Facet&, const GrainBelow&,
                              const ContactFrame&, OverlapWorkspace& work, OverlapMoments&);

}  // namespace trackbed::dem
