#include "dem/contact/flat_contact.h"

#include "dem/contact/eight.h"
#include "dem/contact/face_prism.h"
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
  Vec3 n;        // outward, body axes
  double least;  // cosine that a face must exceed

  Side(const PartView& p, const Mat3& R, const Vec3& direction, double overlap)
      : part(p), n(R.transpose() * direction), least(p.radius > 0 ? 1 - overlap / p.radius : -2) {}
  bool any() const { return part.radius == 0 || any_face(part.core, n, least); }
  template <class Visit>
  void each(Visit&& visit) const {
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
  ContactFrame frame;
  bool framed = false;
  OverlapMoments moments;
  work.clear();
  of_a.each([&](const ConvexView& u) {
    of_b.each([&](const ConvexView& v) {
      if (!framed) frame = contact_frame(u, own, v, pose, balls.n), framed = true;
      dem::overlap(u, own, v, pose, frame, work, moments);
    });
  });
  if (!(moments.volume > 0)) return false;
  out.shape = make_shape(moments, work);
  out.response = StoredEnergyLaw()(out.shape, material);
  set_force(integrate_pressure(work, work.a_pieces, out.shape, out.response), -1, frame, out);
  return true;
}

}  // namespace trackbed::dem
