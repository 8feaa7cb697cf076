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
  const double *nx = nullptr, *ny = nullptr, *nz = nullptr,
               *offset = nullptr;  ///< n.x <= offset inside
  int faces = 0;
  const std::uint16_t* loop_begin = nullptr;  ///< faces+1 entries into loop
  const std::uint16_t* loop = nullptr;        ///< vertex indices, counter-clockwise from outside
  double radius = 0;                          ///< about the body's origin
  /// Optional (null in views made by hand, which then take a slower way): the vertices each vertex
  /// has an edge to, and the faces of each vertex as bits of `face_words` 64-bit words.
  const std::uint16_t* neighbor_begin = nullptr;  ///< vertices+1 entries into neighbor
  const std::uint16_t* neighbor = nullptr;
  const std::uint64_t* vertex_faces = nullptr;  ///< vertices * face_words
  int face_words = 0;
};

class ShapeTable {
 public:
  /// Returns the shape's index. Throws InputError when a face has no area, an edge belongs to one
  /// face only, or there are more than 65535 vertices.
  int add(const GrainShape&);
  ConvexView view(int shape) const;
  int size() const { return static_cast<int>(begin_.size()); }
  const GrainShape& shape(int s) const { return shapes_[s]; }

 private:
  struct Begin {
    int vertex, padded, vertices, face, faces, loop_begin, loop, neighbor_begin, neighbor, bits,
        words;
  };
  std::vector<Begin> begin_;
  std::vector<double> x_, y_, z_, nx_, ny_, nz_, offset_;
  std::vector<std::uint16_t> loop_begin_, loop_, neighbor_begin_, neighbor_;
  std::vector<std::uint64_t> vertex_faces_;
  std::vector<GrainShape> shapes_;
};

}  // namespace trackbed::dem
