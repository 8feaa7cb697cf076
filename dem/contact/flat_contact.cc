#include "dem/contact/flat_contact.h"

#include <algorithm>
#include <cmath>

#include "dem/contact/eight.h"
#include "dem/contact/face_prism.h"
#include "dem/contact/flat_cap.h"
#include "dem/contact/laws/stored_energy.h"

namespace trackbed::dem {
namespace {

// What may overlap of one body: the flat parts at faces with m.n above `least`, n the direction of
// the other body; of a plain polyhedron all of it, told by the face most across n.
struct Side {
  static constexpr int kMost = 8;
  const PartView& part;
  const Mat3& R;
  double least;
  int count = 0;  // more than kMost: not all are listed
  int faces[kMost];

  Side(const PartView& p, const Mat3& turn, const Vec3& direction, double overlap)
      : part(p), R(turn) {
    const ConvexView& v = part.core;
    const Vec3 n = R.transpose() * direction;
    const Eight nx(n.x()), ny(n.y()), nz(n.z());
    const auto across = [&](int f) {
      return fma(nx, Eight::load(v.nx + f),
                 fma(ny, Eight::load(v.ny + f), nz * Eight::load(v.nz + f)));
    };
    least = 1 - overlap / part.radius;
    if (part.radius == 0) {
      Eight most(-1.0);
      for (int f = 0; f < v.faces; f += 8) most = max(most, across(f));
      least = std::nextafter(largest(most), -1);
    }
    for (int f = 0; f < v.faces; f += 8) {
      unsigned bits = less(Eight(least), across(f));
      if (f + 8 > v.faces) bits &= (1u << (v.faces - f)) - 1;  // padding
      for (; bits; bits &= bits - 1, ++count)
        if (count < kMost) faces[count] = f + __builtin_ctz(bits);
    }
    if (part.radius == 0) count = 1;
  }
  Vec3 normal(int k) const {
    const ConvexView& v = part.core;
    return R * Vec3(v.nx[faces[k]], v.ny[faces[k]], v.nz[faces[k]]);
  }
  // visit(flat face) until it is false.
  template <class Visit>
  bool all(Visit&& visit) const {
    for (int k = 0; k < count; ++k) {
      const int prisms = part.radius == 0 ? 1 : prisms_of(part.core, faces[k], kFlatCorners);
      for (int j = 0; j < prisms; ++j)
        if (!visit(FlatFace{faces[k], part.radius, j})) return false;
    }
    return true;
  }
  // visit(prism), whatever their number.
  template <class Visit>
  void each_prism(Visit&& visit) const {
    const ConvexView& v = part.core;
    if (part.radius == 0) return visit(v);
    FacePrism prism;
    for (int f = 0, k = 0; f < v.faces; ++f) {
      if (count <= kMost && (k >= count || faces[k] != f)) continue;
      ++k;
      for (int j = 0; j < prisms_of(v, f); ++j) {
        make_face_prism(v, f, j, part.radius, prism);
        visit(prism.view);
      }
    }
  }
};

// Face by face. False: of one pair of them it cannot be told so.
bool thin_overlap(const Side& a, const Pose& pa, const Side& b, const Pose& pb,
                  const ContactFrame& frame, double thickness, OverlapWorkspace& work,
                  OverlapMoments& moments) {
  return a.all([&](const FlatFace& f) {
    return b.all([&](const FlatFace& g) {
      return overlap_of_faces(a.part.core, pa, f, b.part.core, pb, g, frame, thickness, work,
                              moments) != FlatOverlap::unsure;
    });
  });
}

// The only pair of faces that overlaps, by a cap. `unsure`: there are more, or it is none.
FlatOverlap single_cap(const Side& a, const Pose& pa, const Side& b, const Pose& pb,
                       SimpleContact& cap) {
  FlatOverlap all = FlatOverlap::nothing;
  a.all([&](const FlatFace& f) {
    return b.all([&](const FlatFace& g) {
      SimpleContact other;
      SimpleContact& c = all == FlatOverlap::nothing ? cap : other;
      const FlatOverlap is = flat_cap(a.part.core, pa.R, f, b.part.core, pb, g, c);
      if (is == FlatOverlap::nothing) return true;
      const bool first = is == FlatOverlap::found && all == FlatOverlap::nothing;
      all = first ? is : FlatOverlap::unsure;
      return first;
    });
  });
  return all;
}

void any_overlap(const Side& a, const Pose& pa, const Side& b, const Pose& pb, const Vec3& n,
                 ContactFrame& frame, OverlapWorkspace& work, OverlapMoments& moments) {
  bool framed = false;
  a.each_prism([&](const ConvexView& u) {
    b.each_prism([&](const ConvexView& v) {
      if (!framed) frame = contact_frame(u, pa, v, pb, n), framed = true;
      overlap(u, pa, v, pb, frame, work, moments);
    });
  });
}

void respond(const SimpleContact& s, const PairMaterial& material, NormalContact& out) {
  out.shape = s.shape;
  out.response = StoredEnergyLaw()(s.shape, material);
  set_force(integrate_pressure(s.corner, s.corners, s.shape, out.response), s.of_a ? -1 : 1,
            s.frame, out);
}

}  // namespace

bool flat_contact(const PartView& a, const Mat3& Ra, const PartView& b, const Pose& pose,
                  const DeepestBalls& balls, const PairMaterial& material, OverlapWorkspace& work,
                  NormalContact& out) {
  // How thick the bodies' common slab along n is: the cores' own farthest points along n lie past x
  // and y by crown/4 R^2 at most, R their distance from the centre.
  const double overlap = balls.overlap + (a.radius - balls.ra) + (b.radius - balls.rb) +
                         a.crown / 4 * a.core.radius * a.core.radius +
                         b.crown / 4 * b.core.radius * b.core.radius;
  const Side of_a(a, Ra, balls.n, overlap), of_b(b, pose.R, -balls.n, overlap);
  if (of_a.count == 0 || of_b.count == 0) return false;
  const Pose own{Ra, Vec3::Zero()};
  // No deeper in any of the prisms either, so that those higher than this end outside.
  const double thickness = 1.01 * overlap;
  const bool thin = (a.radius == 0 || thickness < a.radius) &&
                    (b.radius == 0 || thickness < b.radius) &&
                    std::max(of_a.count, of_b.count) <= Side::kMost;
  if (thin) {
    SimpleContact cap;
    const FlatOverlap found = single_cap(of_a, own, of_b, pose, cap);
    if (found == FlatOverlap::nothing) return false;
    if (found == FlatOverlap::found) return respond(cap, material, out), true;
  }
  OverlapMoments moments;
  work.clear();
  // Along a flat part's normal depths keep their digits.
  const Vec3 normal = a.radius > 0 ? of_a.normal(0) : Vec3(-of_b.normal(0));
  ContactFrame frame{balls.x + (balls.ra - balls.overlap / 2) * balls.n, axes_along(normal)};
  if (!thin || !thin_overlap(of_a, own, of_b, pose, frame, thickness, work, moments)) {
    work.clear();
    moments = OverlapMoments();
    any_overlap(of_a, own, of_b, pose, balls.n, frame, work, moments);
  }
  if (!(moments.volume > 0)) return false;
  out.shape = make_shape(moments, work);
  out.response = StoredEnergyLaw()(out.shape, material);
  const bool by_a = work.a_pieces.size() <= work.b_pieces.size();  // either's pieces would do
  const auto& pieces = by_a ? work.a_pieces : work.b_pieces;
  set_force(integrate_pressure(work, pieces, out.shape, out.response), by_a ? -1 : 1, frame, out);
  return true;
}

}  // namespace trackbed::dem
