// The flat part of a dilated polyhedron at one of its faces: the prism of height r that stands on
// the core's face. Beyond it the body is round.
#pragma once
#include "dem/contact/shape_table.h"

namespace trackbed::dem {

/// A prism as the overlap kernel reads it, body frame. Not copyable: the view points into it.
struct FacePrism {
  static constexpr int kCorners = 16;  ///< most of the base; larger faces are cut into several
  double x[2 * kCorners], y[2 * kCorners], z[2 * kCorners];
  double nx[kCorners + 2], ny[kCorners + 2], nz[kCorners + 2], offset[kCorners + 2];
  std::uint16_t loop[6 * kCorners], loop_begin[kCorners + 3];
  std::uint64_t vertex_faces[2 * kCorners];
  ConvexView view;

  FacePrism() = default;
  FacePrism(const FacePrism&) = delete;
  FacePrism& operator=(const FacePrism&) = delete;
};

/// Into how many prisms of so many corners that of a face is cut, fans about its first corner;
/// neighbours share a wall.
inline int prisms_of(const ConvexView& v, int face, int corners = FacePrism::kCorners) {
  const int triangles = v.loop_begin[face + 1] - v.loop_begin[face] - 2, fan = corners - 2;
  return triangles <= fan ? 1 : (triangles + fan - 1) / fan;
}

/// The k-th of them.
void make_face_prism(const ConvexView&, int face, int k, double height, FacePrism&);

}  // namespace trackbed::dem
