#include "dem/contact/overlap.h"

#include "dem/contact/cone_sums.h"
#include "dem/contact/flat_overlap.h"
#include "dem/contact/overlap_clip.h"
#include "dem/contact/overlap_simple.h"

namespace trackbed::dem {
namespace {

constexpr double kFlatsSure = 1e-12;  // of the volume

// Moments of a tetrahedron about the mean of its corners, where the first moments vanish:
// V/20 sum_i y_i y_i^T.
OverlapMoments tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double x = 0.25 * (a.x() + b.x() + c.x() + d.x()),
               y = 0.25 * (a.y() + b.y() + c.y() + d.y()),
               z = 0.25 * (a.z() + b.z() + c.z() + d.z());
  const double ux = b.x() - a.x(), uy = b.y() - a.y(), uz = b.z() - a.z();
  const double vx = c.x() - a.x(), vy = c.y() - a.y(), vz = c.z() - a.z();
  const double wx = d.x() - a.x(), wy = d.y() - a.y(), wz = d.z() - a.z();
  OverlapMoments m;
  m.volume = -((uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz) / 6;
  m.about = Vec3(x, y, z);
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  for (const Vec3* p : {&a, &b, &c, &d}) {
    const double px = p->x() - x, py = p->y() - y, pz = p->z() - z;
    xx += px * px, yy += py * py, zz += pz * pz;
    xy += px * py, xz += px * pz, yz += py * pz;
  }
  const double w = m.volume / 20;
  m.second << w * xx, w * xy, w * xz, w * xy, w * yy, w * yz, w * xz, w * yz, w * zz;
  return m;
}

// How much a workspace holds, to take back what was appended since.
struct Mark {
  std::size_t points, a, b;
  explicit Mark(const OverlapWorkspace& w)
      : points(w.points.size()), a(w.a_pieces.size()), b(w.b_pieces.size()) {}
  void back(OverlapWorkspace& w) const {
    w.points.resize(points), w.a_pieces.resize(a), w.b_pieces.resize(b);
  }
};

// Whether the vector areas of what was appended add up to nothing, within 1e-8 of their size: the
// volume is that sure.
bool closes(const Mark& mark, const OverlapWorkspace& work) {
  Vec3 sum = Vec3::Zero();
  double squares = 0;
  const auto add = [&](const std::vector<OverlapPiece>& pieces, std::size_t from) {
    for (std::size_t i = from; i < pieces.size(); ++i)
      sum += pieces[i].area, squares += pieces[i].area.squaredNorm();
  };
  add(work.a_pieces, mark.a), add(work.b_pieces, mark.b);
  return sum.squaredNorm() <= 1e-16 * squares;
}

// The same of flat parts, thin along z. Areas that are missing, c along z and h across it, change
// the volume by c times its thickness and h times its width: a strip of a wall is small, and counts
// by its distance. Sure is what changes it by no more than a share of it, or than planes do that
// are known to `rounding` [m].
bool closes_flat(const Mark& mark, const OverlapWorkspace& work, double volume, double rounding) {
  double x = 0, y = 0, z = 0, up = 0, surface = 0;
  const auto add = [&](const std::vector<OverlapPiece>& pieces, std::size_t from) {
    for (std::size_t i = from; i < pieces.size(); ++i) {
      const Vec3& a = pieces[i].area;
      x += a.x(), y += a.y(), z += a.z();
      up += std::abs(a.z()), surface += std::abs(a.x()) + std::abs(a.y());
    }
  };
  add(work.a_pieces, mark.a), add(work.b_pieces, mark.b);
  surface += up;
  const double area = up / 2, sure = kFlatsSure * volume + rounding * surface;
  return std::abs(z) * volume <= area * sure && (x * x + y * y) * area <= sure * sure;
}

PlacedBody placed(const ConvexView& v, const Pose& p, const ContactFrame& frame) {
  const Mat3 to_frame = frame.axes.transpose();
  return {v, to_frame * p.R, to_frame * (p.x - frame.origin)};
}

// Adds the moments of what was appended; takes it back when it has no volume.
bool sum_moments(bool is_tetrahedron, const Mark& mark, OverlapWorkspace& work,
                 OverlapMoments& moments) {
  if (is_tetrahedron && !(moments.volume > 0)) {
    const Vec3* p = work.points.data() + mark.points;
    const OverlapMoments m = tetrahedron(p[0], p[1], p[2], p[5]);
    if (m.volume > 0) return moments = m, true;
  }
  Vec3 about = moments.about;
  const std::size_t count = work.points.size() - mark.points;
  if (!(moments.volume > 0) && count > 0) {  // a point inside: the mean of the corners
    about.setZero();
    for (std::size_t i = mark.points; i < work.points.size(); ++i) about += work.points[i];
    about /= static_cast<double>(count);
  }
  ConeSums sum;
  const auto add = [&](const OverlapPiece& piece) {
    sum.add(work.points.data() + piece.first, piece.count, about);
  };
  for (std::size_t i = mark.a; i < work.a_pieces.size(); ++i) add(work.a_pieces[i]);
  for (std::size_t i = mark.b; i < work.b_pieces.size(); ++i) add(work.b_pieces[i]);
  if (!(sum.six > 0)) {
    mark.back(work);
    return false;
  }
  moments.about = about;
  sum.add_to(moments);
  return true;
}

}  // namespace

bool overlap(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
             const ContactFrame& frame, OverlapWorkspace& work, OverlapMoments& moments) {
  const PlacedBody body_a = placed(a, pa, frame), body_b = placed(b, pb, frame);
  const Mark mark(work);
  work.feature = {};
  const Clipped small = clip_small(body_a, body_b, work);
  if (small == Clipped::nothing) return false;
  if (small == Clipped::too_large) {
    mark.back(work);
    if (!clip_any(body_a, body_b, work)) return false;
  }
  if (small != Clipped::tetrahedron && !closes(mark, work)) {
    mark.back(work);
    work.feature = {};
    clip_closed(body_a, body_b, work);
  }
  return sum_moments(small == Clipped::tetrahedron, mark, work, moments);
}

FlatOverlap overlap_of_faces(const ConvexView& a, const Pose& pa, const FlatFace& on_a,
                             const ConvexView& b, const Pose& pb, const FlatFace& on_b,
                             const ContactFrame& frame, double thickness, OverlapWorkspace& work,
                             OverlapMoments& moments) {
  const Mark mark(work);
  const OverlapMoments before = moments;
  if (clip_flats(placed(a, pa, frame), on_a, placed(b, pb, frame), on_b, thickness, work)) {
    if (work.points.size() == mark.points) return FlatOverlap::nothing;
    if (!sum_moments(false, mark, work, moments)) return FlatOverlap::nothing;
    if (closes_flat(mark, work, moments.volume - before.volume, 1e-15 * (a.radius + b.radius)))
      return FlatOverlap::found;
  }
  moments = before;
  mark.back(work);
  return FlatOverlap::unsure;
}

bool overlap_again(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                   const ContactFrame& frame, const OverlapFeature& feature, OverlapWorkspace& work,
                   OverlapMoments& moments) {
  const PlacedBody body_a = placed(a, pa, frame), body_b = placed(b, pb, frame);
  const Mark mark(work);
  if (!clip_faces(body_a, body_b, feature, work)) {
    mark.back(work);
    return false;
  }
  return sum_moments(false, mark, work, moments);
}

}  // namespace trackbed::dem
