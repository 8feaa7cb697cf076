#include "dem/surface/flat_patch.h"

#include "dem/contact/eight.h"
#include "dem/contact/face_prism.h"

namespace trackbed::dem {
namespace {

// Of the body's lowest vertex.
double height_over(const ConvexView& v, const Pose& pose, const Facet& facet) {
  const Vec3 n = pose.R.transpose() * facet.normal;
  const Eight nx(n.x()), ny(n.y()), nz(n.z());
  Eight low(HUGE_VAL);
  for (int k = 0; k < v.padded; k += 8)
    low = min(low, fma(nx, Eight::load(v.x + k),
                       fma(ny, Eight::load(v.y + k), nz * Eight::load(v.z + k))));
  return least(low) + facet.normal.dot(pose.x - facet.origin);
}

}  // namespace

bool cut_flats(const PartView& part, const Pose& pose, const SurfacePatch& patch,
               const std::vector<NearTriangle>& near, double thickness, OverlapWorkspace& work,
               FacetOverlaps& out, bool framed) {
  const ConvexView& core = part.core;
  const bool again = framed;
  clear(work, out);
  Facet facet;
  FacePrism prism;
  for (const NearTriangle& t : near) {
    if (t.overlap <= -kAside * thickness) continue;
    make_facet(patch, t.triangle, t.shift, facet);
    const double height = height_over(core, pose, facet);
    const Vec3 into = -(pose.R.transpose() * facet.normal);
    for (int f = 0; f < core.faces; ++f) {
      if (!(part.radius * into.dot(Vec3(core.nx[f], core.ny[f], core.nz[f])) > height)) continue;
      for (int k = 0; k < prisms_of(core, f); ++k) {
        make_face_prism(core, f, k, part.radius, prism);
        framed |= cut_facet(prism.view, pose, patch, facet, t.triangle, t.shift, framed, work, out);
      }
    }
  }
  if (!again && turn_frame(work, out))
    return cut_flats(part, pose, patch, near, thickness, work, out, true);
  return out.moments.volume > 0 && !out.pieces.empty();
}

bool press_flats(const PartView& part, const Pose& pose, const PairMaterial& material,
                 const SurfacePatch& patch, const std::vector<NearTriangle>& near,
                 const SurfaceBalls& balls, OverlapWorkspace& work, FlatPressure& out) {
  out.nodal.clear(), out.share.clear(), out.arm.clear();
  const bool overlaps = cut_flats(part, pose, patch, near, thickness(part, balls), work, out.cut);
  out.through = out.cut.through;
  if (!overlaps) return false;
  out.shape = surface_shape(out.cut, work);
  out.response = StoredEnergyLaw()(out.shape, material);
  const SurfacePressure pressed =
      press_on_surface(out.cut, work, patch, out.shape, out.response, out.nodal, out.share);
  out.on_grain = pressed.on_grain;
  for (std::size_t j = 0; j < out.nodal.size(); ++j) {
    out.share[j] /= pressed.area;
    out.arm.push_back(patch.node[out.nodal[j].first] + out.cut.pieces[j / 3].shift - pose.x);
  }
  return pressed.area > 0 && pressed.on_grain != Vec3::Zero();
}

}  // namespace trackbed::dem
