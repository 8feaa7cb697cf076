// Overlap of two convex polyhedra by clipping: volume, moments, and the pieces of both
// boundaries that bound it. Everything is computed in a contact frame whose third axis is the
// expected normal, so that flat overlaps (depth 1e-9 of the contact's width) keep their digits.
//
// Method. The boundary of the overlap of a and b is a's faces inside b and b's faces inside a. Only
// what lies in the common slab, between b's lowest and a's highest point along the frame's normal,
// can meet: faces outside it are never touched, and of those inside only the planes that cut the
// other body's part of the slab are clipped with (Sutherland & Hodgman, CACM 17, 1974). Moments
// follow from the divergence theorem about a point inside the overlap, so that all terms have one
// sign and flat overlaps keep their relative accuracy. Where faces of a and b with the same outward
// normal coincide, the surface belongs to a alone (both are clipped by the difference of the two
// planes, which has the same sign for both bodies up to rounding of the difference itself).
//
// A pair is used like this:
//   workspace.clear();
//   OverlapMoments moments;
//   const ContactFrame frame = contact_frame(a, pa, b, pb, axis);
//   if (overlap(a, pa, b, pb, frame, workspace, moments)) {
//     const OverlapShape shape = make_shape(moments, workspace);
//     const NormalResponse response = law(shape, material);
//     const PressureForce f = integrate_pressure(workspace, workspace.a_pieces, shape, response);
//   }
#pragma once
#include <cmath>
#include <vector>

#include "dem/contact/shape_table.h"
#include "dem/types.h"

namespace trackbed::dem {

struct Pose {
  Mat3 R;  ///< body -> world
  Vec3 x;  ///< world position of the body's origin [m]
};

/// Local frame of a contact: p_world = origin + axes * p_local; axes.col(2) is the expected
/// normal, from body a to body b. It steers culling and conditioning, never the exact result.
struct ContactFrame {
  Vec3 origin;
  Mat3 axes;
};

/// A right-handed basis with third axis n (unit) that depends smoothly on n but for n.z = 0 (Duff
/// et al., JCGT 6, 2017).
inline Mat3 axes_along(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z()), u = -1.0 / (sign + n.z()), w = n.x() * n.y() * u;
  Mat3 axes;
  axes << 1.0 + sign * n.x() * n.x() * u, w, n.x(),  //
      sign * w, sign + n.y() * n.y() * u, n.y(),     //
      -sign * n.x(), -n.y(), n.z();
  return axes;
}

/// A polygon of one body's face inside the other body: points [first, first+count) of
/// OverlapWorkspace::points, in frame coordinates, counter-clockwise seen from outside that body;
/// `area` is its vector area (outward from the body it belongs to).
struct OverlapPiece {
  int face;
  int first, count;
  Vec3 area;
};

/// What an overlap is made of, where overlap_feature.h may start from in the next step.
struct OverlapFeature {
  int code = 0;                  ///< of a SimpleFeature, 0 = of no simple kind
  int faces_a = 0, faces_b = 0;  ///< else the faces that bound it, as bits; 0 = not known
  explicit operator bool() const { return code != 0 || faces_a != 0; }
};

/// Scratch of one thread; no allocation once warm.
struct OverlapWorkspace {
  std::vector<Vec3> points;
  std::vector<OverlapPiece> a_pieces, b_pieces;
  OverlapFeature feature;  ///< of the last overlap found

  void clear() { points.clear(), a_pieces.clear(), b_pieces.clear(), feature = {}; }

  // Scratch of overlap(): what is inside the slab of one body, and two polygons.
  struct Cap {
    std::vector<double> x, y, z;                          // all vertices
    std::vector<double> px, py, pz;                       // corners of the part in the slab
    std::vector<double> nx, ny, nz, offset, most, least;  // planes of the faces in the slab
    std::vector<int> face;                                // those faces
    std::vector<std::uint64_t> bits;
    int corners = 0, faces = 0;
  } cap_a, cap_b;
  struct Polygon {
    std::vector<double> x, y, z;
    int n = 0;
  } polygon[2];
  std::vector<double> distance;
};

/// Moments of the overlap about the point `about`, in frame axes: volume [m3], first
/// int (x-about) dV [m4], second int (x-about)(x-about)^T dV [m5]. They add up over the cells of a
/// shell: the first overlap found (volume still 0) sets `about`, a point inside it, the others
/// keep it.
struct OverlapMoments {
  double volume = 0;
  Vec3 about = Vec3::Zero();  ///< frame coordinates [m]
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
};

/// Unit direction from a to b along which the bodies are separated, or the best one found while
/// they overlap; starts from `axis` (the pair's cached one, any length incl. zero). Returns the gap
/// along it [m]: positive = separated for certain.
double separating_axis(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                       Vec3& axis);

/// A frame for the pair, origin in the middle of the bodies' common slab. Its third axis is `axis`
/// (any length), or, when a face's normal lies within 8 degrees of it, that normal: flat overlaps
/// lie between nearly parallel faces. For the normal of friction use the area vector of the pieces.
ContactFrame contact_frame(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                           const Vec3& axis);

/// Clips a's faces by b's planes and b's by a's. Appends to the workspace's pieces (the caller
/// clears it) and adds to `moments`. False when the bodies do not overlap, or by less than rounding
/// can tell (1e-15 of their size); nothing is appended then.
bool overlap(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
             const ContactFrame&, OverlapWorkspace&, OverlapMoments& moments);

}  // namespace trackbed::dem
