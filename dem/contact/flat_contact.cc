#include "dem/contact/flat_contact.h"

#include <algorithm>
#include <cmath>

#include "dem/contact/eight.h"
#include "dem/contact/face_prism.h"
#include "dem/contact/flat_overlap.h"
#include "dem/contact/laws/stored_energy.h"

namespace trackbed::dem {
namespace {

// A face of a part with m.n (body axes) above `least`, from `from` on; `faces` if there is none.
int next_face(const ConvexView& v, const Vec3& n, double least, int from) {
  int f = from;
  while (f < v.faces && !(v.nx[f] * n.x() + v.ny[f] * n.y() + v.nz[f] * n.z() > least)) ++f;
  return f;
}

bool any_face(const ConvexView& v, const Vec3& n, double least) {
  if (!v.planes_padded) return next_face(v, n, least, 0) < v.faces;
  const Eight nx(n.x()), ny(n.y()), nz(n.z());
  Eight best(-1.0);
  for (int f = 0; f < v.faces; f += 8)
    best = max(best, fma(nx, Eight::load(v.nx + f),
                         fma(ny, Eight::load(v.ny + f), nz * Eight::load(v.nz + f))));
  return largest(best) > least;
}

// What may overlap of one body.
struct Side {
  const PartView& part;
  const Mat3& R;
  Vec3 n;        // outward, body axes
  double least;  // cosine that a face must exceed

  Side(const PartView& p, const Mat3& turn, const Vec3& direction, double overlap)
      : part(p),
        R(turn),
        n(R.transpose() * direction),
        least(p.radius > 0 ? 1 - overlap / p.radius : -2) {}
  bool any() const { return part.radius == 0 || any_face(part.core, n, least); }
  FlatFace first_face() const {
    const ConvexView& v = part.core;
    if (part.radius > 0) return {next_face(v, n, least, 0), part.radius};
    int best = 0;  // of a plain polyhedron the one most across n
    const auto across = [&](int f) { return v.nx[f] * n.x() + v.ny[f] * n.y() + v.nz[f] * n.z(); };
    for (int f = 1; f < v.faces; ++f)
      if (across(f) > across(best)) best = f;
    return {best, 0};
  }
  // The next one, `faces` if there is none.
  FlatFace after(const FlatFace& on) const {
    return {part.radius > 0 ? next_face(part.core, n, least, on.face + 1) : part.core.faces,
            part.radius};
  }
  Vec3 normal(const FlatFace& on) const {
    const ConvexView& v = part.core;
    return R * Vec3(v.nx[on.face], v.ny[on.face], v.nz[on.face]);
  }
  template <class Visit>
  void each_prism(Visit&& visit) const {
    if (part.radius == 0) return visit(part.core);
    FacePrism prism;
    for (int f = next_face(part.core, n, least, 0); f < part.core.faces;
         f = next_face(part.core, n, least, f + 1))
      for (int k = 0; k < prisms_of(part.core, f); ++k) {
        make_face_prism(part.core, f, k, part.radius, prism);
        visit(prism.view);
      }
  }
};

// Face by face. False: of one pair of them it cannot be told so.
bool thin_overlap(const Side& a, const Pose& pa, const Side& b, const Pose& pb,
                  const ContactFrame& frame, double thickness, OverlapWorkspace& work,
                  OverlapMoments& moments) {
  for (FlatFace f = a.first_face(); f.face < a.part.core.faces; f = a.after(f))
    for (FlatFace g = b.first_face(); g.face < b.part.core.faces; g = b.after(g))
      if (overlap_of_faces(a.part.core, pa, f, b.part.core, pb, g, frame, thickness, work,
                           moments) == FlatOverlap::unsure)
        return false;
  return true;
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
  if (!of_a.any() || !of_b.any()) return false;
  const Pose own{Ra, Vec3::Zero()};
  OverlapMoments moments;
  work.clear();
  const bool of_a_first = a.radius > 0;  // along a flat part's normal depths keep their digits
  const Vec3 normal = of_a_first ? of_a.normal(of_a.first_face()) : -of_b.normal(of_b.first_face());
  ContactFrame frame{balls.x + (balls.ra - balls.overlap / 2) * balls.n, axes_along(normal)};
  const double height =
      std::min(a.radius > 0 ? a.radius : HUGE_VAL, b.radius > 0 ? b.radius : HUGE_VAL);
  if (!(overlap < height / 4) ||
      !thin_overlap(of_a, own, of_b, pose, frame, 1.01 * overlap, work, moments)) {
    work.clear();
    moments = OverlapMoments();
    any_overlap(of_a, own, of_b, pose, balls.n, frame, work, moments);
  }
  if (!(moments.volume > 0)) return false;
  out.shape = make_shape(moments, work);
  out.response = StoredEnergyLaw()(out.shape, material);
  set_force(integrate_pressure(work, work.a_pieces, out.shape, out.response), -1, frame, out);
  return true;
}

}  // namespace trackbed::dem
