#include "dem/contact/candidates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/contact/cell_grid.h"
#include "dem/contact/eight_vectors.h"
#include "dem/contact/part_pairs.h"

namespace trackbed::dem {
namespace {

double radius(const Bodies& b, const ShapeTable& shapes, int i) {
  return shapes.view(b.shape[i]).radius;
}

/// Box i moved by `shift` against box j.
template <class Box>
bool meet(const Box& i, const Box& j, const Vec3& shift) {
  return ((j.low + shift).array() <= i.high.array()).all() &&
         (i.low.array() <= (j.high + shift).array()).all();
}

/// Some face plane of `body` has the sphere (centre, r) outside it.
bool outside_a_face(const ConvexView& body, const Mat3& R, const Vec3& x, const Vec3& centre,
                    double r) {
  const Vec3 p = R.transpose() * (centre - x);
  for (int f = 0; f < body.faces; ++f)
    if (body.nx[f] * p.x() + body.ny[f] * p.y() + body.nz[f] * p.z() - body.offset[f] > r)
      return true;
  return false;
}

bool both_held(const Bodies& b, int i, int j) {
  return b.freedom[i] == kFixed && b.freedom[j] == kFixed;
}

/// Indices of the pairs by their keys. Within a kind two runs are sorted already (see Pairs).
std::vector<int> sorted_by_key(const Pairs& pairs) {
  std::vector<int> order(pairs.size());
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int p, int q) { return pairs.key(p) < pairs.key(q); };
  for (int kind = 0; kind < kPairKinds; ++kind) {
    const auto begin = order.begin() + pairs.kind_first[kind],
               end = order.begin() + pairs.kind_first[kind + 1];
    std::inplace_merge(begin, std::is_sorted_until(begin, end, less), end, less);
  }
  return order;
}

/// Puts first, within each kind, the pairs of bodies that touch in some of their parts. `order`:
/// indices of pairs by their keys.
void touching_first(const Pairs& pairs, std::vector<int>& order) {
  std::vector<char> touch(pairs.size(), 0);  // of the bodies
  const auto same_bodies = [&](int p, int q) {
    return pairs.kind[p] == pairs.kind[q] && pairs.a[p] == pairs.a[q] && pairs.b[p] == pairs.b[q];
  };
  for (auto at = order.begin(); at != order.end();) {
    const auto next = std::find_if(at, order.end(), [&](int p) { return !same_bodies(*at, p); });
    const bool any = std::any_of(at, next, [&](int p) { return pairs.touching[p]; });
    for (; at != next; ++at) touch[*at] = any;
  }
  std::stable_sort(order.begin(), order.end(), [&](int p, int q) {
    return std::pair(pairs.kind[p], !touch[p]) < std::pair(pairs.kind[q], !touch[q]);
  });
}

double default_skin(const Bodies& b, const ShapeTable& shapes) {
  const int n = b.grains > 0 ? b.grains : b.size();
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += radius(b, shapes, i);
  return n > 0 ? 0.1 * sum / n : 0;
}

}  // namespace

bool Candidates::update(const Bodies& b, const ShapeTable& shapes, const StepContext& c,
                        Pairs& pairs) {
  const bool again = outdated(b, shapes, c);
  if (again) rebuild(b, shapes, c, pairs);
  return again;
}

bool Candidates::outdated(const Bodies& b, const ShapeTable& shapes, const StepContext& c) {
  if (static_cast<int>(state_.travel.size()) != b.size()) return true;
  if (static_cast<int>(radius_.size()) != b.size()) find_radii(b, shapes);
  const int n = b.size();
  const int threads = c.threads_for(n);
  bool far = false;
#pragma omp parallel for schedule(static) reduction(|| : far) num_threads(threads) if (threads > 1)
  for (int row = 0; row < n; row += 8) {
    const Eightfold e = Eightfold::row(row, std::min(8, n - row));
    const Eight step = sqrt(squared_norm(read(b.v.data(), e))),
                turn = sqrt(squared_norm(read(b.turn.data(), e)));
    const Eight travel =
        read(state_.travel.data(), e) + c.dt * step + read(radius_.data(), e) * turn;
    write(state_.travel.data(), e, travel);
    const Eight since = travel - read(state_.travel_search.data(), e);
    far = far || less_equal(since, state_.skin / 2) != 0xff;  // also what is no number
  }
  return far;
}

void Candidates::find_radii(const Bodies& b, const ShapeTable& shapes) {
  radius_.resize(b.size());
  for (int i = 0; i < b.size(); ++i) radius_[i] = radius(b, shapes, i);
}

void Candidates::rebuild(const Bodies& b, const ShapeTable& shapes, const StepContext& c,
                         Pairs& pairs) {
  state_.skin = settings_.skin > 0 ? settings_.skin : default_skin(b, shapes);
  find_radii(b, shapes);
  make_boxes(b, shapes, c.threads);
  found_.clear();
  search_grains(b, c);
  search_rigid(b, shapes, c);
  std::sort(found_.begin(), found_.end());
  keys_.clear();
  find_part_pairs(b, shapes, found_, c.period, state_.skin, keys_);
  carry_history(b.size(), pairs);
  std::vector<int> kept = near_pairs(b, shapes, c, pairs);
  touching_first(pairs, kept);
  pairs.rearrange(kept);
  pairs.index_bodies(b.size());
  ++state_.rebuilds;
}

void Candidates::make_boxes(const Bodies& b, const ShapeTable& shapes, int threads) {
  boxes_.resize(b.size());
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (int i = 0; i < b.size(); ++i) {
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    for (int k = 0; k < shapes.parts(b.shape[i]); ++k)
      include_part(shapes.part(b.shape[i], k), b.R[i], low, high);
    const Vec3 skin = Vec3::Constant(state_.skin / 2);
    boxes_[i] = {b.x[i] + low - skin, b.x[i] + high + skin};
  }
}

void Candidates::search_grains(const Bodies& b, const StepContext& c) {
  double width = 0;
  for (int i = 0; i < b.grains; ++i)
    width = std::max(width, 2 * std::max((boxes_[i].high - b.x[i]).maxCoeff(),
                                         (b.x[i] - boxes_[i].low).maxCoeff()));
  const CellGrid grid(b.x.data(), b.grains, width, c.period);
  std::vector<std::vector<std::pair<int, int>>> rows(grid.cells());
#pragma omp parallel for schedule(dynamic, 16) num_threads(c.threads) if (c.threads > 1)
  for (int cell = 0; cell < grid.cells(); ++cell)
    grid.for_each_near(cell, [&](int i, int j) {
      if (i < j && !both_held(b, i, j) &&
          meet(boxes_[i], boxes_[j], nearest_image(b.x[i], b.x[j], c.period)))
        rows[cell].push_back({i, j});
    });
  for (const auto& row : rows) found_.insert(found_.end(), row.begin(), row.end());
}

void Candidates::search_rigid(const Bodies& b, const ShapeTable& shapes, const StepContext& c) {
  for (int r = b.grains; r < b.size(); ++r) {
    const ConvexView body = shapes.view(b.shape[r]);
    for (int i = 0; i < (settings_.rigid_pairs ? r : b.grains); ++i) {
      if (both_held(b, i, r)) continue;
      const Vec3 shift = nearest_image(b.x[i], b.x[r], c.period);
      if (!meet(boxes_[i], boxes_[r], shift)) continue;
      if (outside_a_face(body, b.R[r], b.x[r] + shift, b.x[i], radius(b, shapes, i) + state_.skin))
        continue;
      found_.push_back({i, r});
    }
  }
}

void Candidates::carry_history(int bodies, Pairs& pairs) {
  state_.travel.resize(bodies, 0);
  state_.travel_search = state_.travel;

  // Both lists sorted: old place of each new pair, or -1.
  const std::vector<int> by_key = sorted_by_key(pairs);
  const int n = static_cast<int>(keys_.size()), before = pairs.size();
  std::vector<int> old(n, -1);
  for (int p = 0, o = 0; p < n; ++p) {
    while (o < before && pairs.key(by_key[o]) < keys_[p]) ++o;
    if (o < before && pairs.key(by_key[o]) == keys_[p]) old[p] = by_key[o];
  }
  pairs.rearrange(old);
  for (int p = 0; p < n; ++p) pairs.set_key(p, keys_[p]);
  pairs.index_bodies(bodies);
}

std::vector<int> Candidates::near_pairs(const Bodies& b, const ShapeTable& shapes,
                                        const StepContext& c, Pairs& pairs) const {
  std::vector<char> far(pairs.size(), 0);
#pragma omp parallel for schedule(dynamic, 64) num_threads(c.threads) if (c.threads > 1)
  for (int p = 0; p < pairs.end(PairKind::polyhedra); ++p) {
    if (pairs.touching[p] || pairs.friction_loss[p] != 0) continue;
    const int i = pairs.a[p], j = pairs.b[p];
    const double travel = state_.travel[i] + state_.travel[j];
    double gap = pairs.wake[p] - travel;  // at least, of a pair that was looked at before
    if (!(gap > 0)) {
      const Pose pa{b.R[i], b.x[i]};
      const Pose pb{b.R[j], b.x[j] + nearest_image(b.x[i], b.x[j], c.period)};
      gap = separating_axis(shapes.part(b.shape[i], pairs.part_a[p]).core, pa,
                            shapes.part(b.shape[j], pairs.part_b[p]).core, pb, pairs.axis[p]);
      if (gap > 0) pairs.wake[p] = travel + gap;
    }
    far[p] = gap > state_.skin;
  }
  std::vector<int> kept;
  for (int p = 0; p < pairs.size(); ++p)
    if (!far[p]) kept.push_back(p);
  return kept;
}

}  // namespace trackbed::dem
