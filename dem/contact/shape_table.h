// Shapes as the contact kernel reads them: one flat structure of arrays for all shapes,
// vertices padded to the vector width by repeating the last one.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// A convex polyhedron as the kernel sees it (non-owning; body frame).
struct ConvexView {
  const double *x = nullptr, *y = nullptr, *z = nullptr;  ///< vertices, padded
  int vertices = 0, padded = 0;
  const double *nx = nullptr, *ny = nullptr, *nz = nullptr, *offset = nullptr;  ///< n.x <= offset inside
  int faces = 0;
  const std::uint16_t* loop_begin = nullptr;  ///< faces+1 entries into loop
  const std::uint16_t* loop = nullptr;        ///< vertex indices, counter-clockwise from outside
  double radius = 0;                          ///< about the body's origin
};

class ShapeTable {
 public:
  int add(const GrainShape&);  ///< returns the shape's index
  ConvexView view(int shape) const;
  int size() const { return static_cast<int>(begin_.size()); }
  const GrainShape& shape(int s) const { return shapes_[s]; }

 private:
  struct Begin { int vertex, padded, vertices, face, faces, loop; };
  std::vector<Begin> begin_;
  std::vector<double> x_, y_, z_, nx_, ny_, nz_, offset_;
  std::vector<std::uint16_t> loop_begin_, loop_;
  std::vector<GrainShape> shapes_;
};

}  // namespace trackbed::dem
