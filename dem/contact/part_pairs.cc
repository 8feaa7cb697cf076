#include "dem/contact/part_pairs.h"

#include <algorithm>
#include <cmath>

namespace trackbed::dem {
namespace {

struct PartBox {
  int part;
  Vec3 low, high;
};

// Boxes of a body's parts, relative to `origin`, grown; only those that meet [low, high].
void boxes_within(const Bodies& b, const ShapeTable& shapes, int i, const Vec3& offset, double grow,
                  const Vec3& low, const Vec3& high, std::vector<PartBox>& boxes) {
  boxes.clear();
  for (int k = 0; k < shapes.parts(b.shape[i]); ++k) {
    PartBox box{k, Vec3::Constant(HUGE_VAL), Vec3::Constant(-HUGE_VAL)};
    include_part(shapes.part(b.shape[i], k), b.R[i], box.low, box.high);
    box.low += offset - Vec3::Constant(grow), box.high += offset + Vec3::Constant(grow);
    if ((box.low.array() <= high.array()).all() && (low.array() <= box.high.array()).all())
      boxes.push_back(box);
  }
}

void join(const std::vector<PartBox>& boxes, Vec3& low, Vec3& high) {
  low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const PartBox& box : boxes) low = low.cwiseMin(box.low), high = high.cwiseMax(box.high);
}

bool meet(const PartBox& i, const PartBox& j) {
  return (i.low.array() <= j.high.array()).all() && (j.low.array() <= i.high.array()).all();
}

PairKey make_key(const ShapeTable& shapes, const Bodies& b, int i, int part_i, int j, int part_j) {
  bool swapped;
  const PairKind kind =
      pair_kind(shapes.part(b.shape[i], part_i), shapes.part(b.shape[j], part_j), swapped);
  return swapped ? PairKey{kind, j, i, part_j, part_i} : PairKey{kind, i, j, part_i, part_j};
}

}  // namespace

PairKind pair_kind(const PartView& i, const PartView& j, bool& swapped) {
  swapped = j.kind < i.kind;
  const Core first = std::min(i.kind, j.kind), second = std::max(i.kind, j.kind);
  if (first == Core::plain) return PairKind::polyhedra;
  if (first == Core::dilated) return PairKind::cores;
  if (second != Core::point) return PairKind::point_core;
  return i.centred && j.centred ? PairKind::balls : PairKind::points;
}

void include_part(const PartView& part, const Mat3& R, Vec3& low, Vec3& high) {
  if (part.kind == Core::point) {
    const Vec3 c = R * part.centre, r = Vec3::Constant(part.radius);
    low = low.cwiseMin(c - r), high = high.cwiseMax(c + r);
    return;
  }
  const ConvexView& s = part.core;
  Vec3 least = Vec3::Constant(HUGE_VAL), most = -least;
  for (int k = 0; k < s.vertices; ++k) {
    const Vec3 p = R * Vec3(s.x[k], s.y[k], s.z[k]);
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  const Vec3 r = Vec3::Constant(part.radius + part.crown / 2 * part.mean_square);
  low = low.cwiseMin(least - r), high = high.cwiseMax(most + r);
}

void find_part_pairs(const Bodies& b, const ShapeTable& shapes,
                     const std::vector<std::pair<int, int>>& found, const Vec3& period, double skin,
                     std::vector<PairKey>& keys) {
  std::vector<PartBox> of_i, of_j;
  const Vec3 everywhere = Vec3::Constant(HUGE_VAL);
  const auto far = [&](const PartView& u, const Vec3& at_u, const PartView& v, const Vec3& at_v) {
    if (u.kind != Core::point || v.kind != Core::point) return false;
    const double reach = u.radius + v.radius + skin;
    return (at_v - at_u).squaredNorm() > reach * reach;
  };
  for (const auto& [i, j] : found) {
    const Vec3 apart = b.x[j] + nearest_image(b.x[i], b.x[j], period) - b.x[i];
    if (shapes.parts(b.shape[i]) == 1 && shapes.parts(b.shape[j]) == 1) {
      const PartView &u = shapes.part(b.shape[i], 0), &v = shapes.part(b.shape[j], 0);
      if (far(u, b.R[i] * u.centre, v, apart + b.R[j] * v.centre)) continue;
      keys.push_back(make_key(shapes, b, i, 0, j, 0));
      continue;
    }
    Vec3 low, high;
    boxes_within(b, shapes, i, Vec3::Zero(), skin / 2, -everywhere, everywhere, of_i);
    join(of_i, low, high);
    boxes_within(b, shapes, j, apart, skin / 2, low, high, of_j);
    join(of_j, low, high);
    for (const PartBox& p : of_i) {
      if (!meet(p, {0, low, high})) continue;
      for (const PartBox& q : of_j) {
        if (!meet(p, q)) continue;
        const PartView &u = shapes.part(b.shape[i], p.part), &v = shapes.part(b.shape[j], q.part);
        if (far(u, b.R[i] * u.centre, v, apart + b.R[j] * v.centre)) continue;
        keys.push_back(make_key(shapes, b, i, p.part, j, q.part));
      }
    }
  }
  if (!std::is_sorted(keys.begin(), keys.end())) std::sort(keys.begin(), keys.end());
}

}  // namespace trackbed::dem
