// Shapes as the contact kernel reads them: one flat structure of arrays for all shapes, vertices
// and planes padded to eight by repeating the last one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "dem/contact/line_pool.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// A convex polyhedron as the kernel sees it (non-owning; body frame). What most contacts need
/// comes first, in one line of memory.
struct ConvexView {
  const double *nx = nullptr, *ny = nullptr, *nz = nullptr,
               *offset = nullptr;  ///< n.x <= offset inside
  /// Optional: the surroundings of each vertex, `star_size` reals apart (see Star).
  const double* stars = nullptr;
  double radius = 0;  ///< about the body's origin
  int faces = 0, star_size = 0;
  bool planes_padded = false;                             ///< optional: to a multiple of eight
  const double *x = nullptr, *y = nullptr, *z = nullptr;  ///< vertices, padded
  int vertices = 0, padded = 0;
  const std::uint16_t* loop_begin = nullptr;  ///< faces+1 entries into loop
  const std::uint16_t* loop = nullptr;        ///< vertex indices, counter-clockwise from outside
  /// Optional (null in views made by hand, which then take a slower way): the vertices each vertex
  /// has an edge to, clockwise seen from outside, the face left of each such edge v -> w (its loop
  /// runs v, w; it lies between this neighbour and the next), and the faces of each vertex as bits
  /// of `face_words` 64-bit words.
  const std::uint16_t* neighbor_begin = nullptr;  ///< vertices+1 entries into neighbor
  const std::uint16_t *neighbor = nullptr, *left_face = nullptr;
  const std::uint64_t* vertex_faces = nullptr;  ///< vertices * face_words
  int face_words = 0;
  /// Optional: each face's corners, eight x, eight y, eight z, the last repeated (null where a face
  /// has more than eight).
  const double* corners = nullptr;
};

/// One vertex: its place, `edges` edges to its neighbours in the order of ConvexView::neighbor (x
/// of all, then y, then z; eight may be read from each) and the faces left of them. A vertex of
/// more than seven edges, or of a body of more than 64 faces, has `edges` = 0.
struct Star {
  const double* at;
  Star(const ConvexView& v, int vertex) : at(v.stars + v.star_size * vertex) {}
  const unsigned char* counts() const { return reinterpret_cast<const unsigned char*>(at + 3); }
  int edges() const { return counts()[0]; }
  int left_face(int edge) const { return counts()[1 + edge]; }
  int right_face(int edge) const { return left_face((edge > 0 ? edge : edges()) - 1); }
  const double* x() const { return at + 4; }
  const double* y() const { return x() + edges(); }
  const double* z() const { return y() + edges(); }
};

/// The core of a part: a point (spheres), or a polyhedron with or without a radius around it.
enum class Core : std::uint8_t { point, dilated, plain };

/// One convex part of a shape as the kernels read it (see ConvexPart).
struct alignas(64) PartView {
  ConvexView core;             ///< empty for a point
  Vec3 centre = Vec3::Zero();  ///< of a point, body frame [m]
  double radius = 0, crown = 0, mean_square = 0;
  Core kind = Core::plain;
  bool centred = false;  ///< a point at the body's origin
};

/// A part whose core is a point, two to a line of memory: all that pairs of balls read of it.
struct alignas(32) Ball {
  Vec3 centre;  ///< body frame [m]
  double radius;
};

static_assert(offsetof(ConvexView, planes_padded) < 64, "see ConvexView");

class ShapeTable {
 public:
  /// Returns the shape's index. Throws InputError when a face has no area, an edge belongs to one
  /// face only, or there are more than 65535 vertices.
  int add(const GrainShape&);
  /// Parts of a shape: one, the body itself, for a plain polyhedron.
  int parts(int shape) const { return part_first_[shape + 1] - part_first_[shape]; }
  const PartView& part(int shape, int k) const { return parts_[part_first_[shape] + k]; }
  /// Place of a shape's part among all parts, and what pairs of balls read of the one at a place.
  int place(int shape, int k) const { return part_first_[shape] + k; }
  const Ball& ball(int place) const { return balls_[place]; }
  /// The part for laws that let flat faces answer by their area (flat_contact.h): of a dilated
  /// polyhedron's crown only so much is left that edges roll smoothly through parallel, 0.001 over
  /// the core's greatest distance from the centroid, and r is the radius at the core's farthest
  /// corner, elsewhere larger by less than 0.0005 of that distance.
  const PartView& flat_part(int shape, int k) const { return flat_parts_[part_first_[shape] + k]; }
  /// Of the shape's `body`. Valid as long as this table or a copy of it lives.
  const ConvexView& view(int shape) const { return views_[shape]; }
  int size() const { return static_cast<int>(views_.size()); }
  const GrainShape& shape(int s) const { return shapes_[s]; }

 private:
  // Of one shape, besides its reals; never moves or changes.
  struct Arrays {
    std::vector<std::uint64_t> bits;     // vertex_faces
    std::vector<std::uint16_t> indices;  // neighbor_begin, neighbor, left_face, loop_begin, loop
  };
  // `touches`: with stars and corners, which contacts read; the body of a shape with parts has none.
  ConvexView add_view(const Polyhedron&, double radius, bool touches);

  LinePool reals_;  // of each shape: nx, ny, nz, offset; stars; x, y, z; corners
  std::vector<std::shared_ptr<const Arrays>> arrays_;
  std::vector<PartView> parts_, flat_parts_;
  std::vector<Ball> balls_;  // of each part; means nothing of one that is none
  std::vector<int> part_first_{0};
  std::vector<ConvexView> views_;
  std::vector<GrainShape> shapes_;
};

}  // namespace trackbed::dem
