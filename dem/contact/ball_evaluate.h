// The loop over pairs of balls, spheres and those of clumps: eight pairs at a time, one law, with
// or without friction. Included by the file that makes the instances, nowhere else.
#pragma once
#include "dem/contact/eight_contacts.h"
#include "dem/contact/fetch.h"
#include "dem/contact/round_release.h"
#include "dem/contact/shares.h"

namespace trackbed::dem {

inline Eight image(Eight apart, double period) {
  if (!(period > 0) || all_less(2 * abs(apart), Eight(period))) return 0;
  return each(apart, [&](double d) {
    return 2 * std::abs(d) >= period ? -period * std::round(d / period) : 0;
  });
}

/// Overlaps of the pairs named in `e` (negative: apart), and the rest of what it holds. `centred`:
/// the balls' centres are those of their bodies.
inline void find_overlaps(const Bodies& b, const ShapeTable& shapes, const StepContext& c,
                          const Pairs& pairs, bool centred, EightContacts& e) {
  e.apart = read(b.x.data(), e.b) - read(b.x.data(), e.a);
  e.apart = e.apart + Eight3(image(e.apart.x, c.period.x()), image(e.apart.y, c.period.y()),
                             image(e.apart.z, c.period.z()));
  const Eight ra = read(pairs.radius_a.data(), e.pair), rb = read(pairs.radius_b.data(), e.pair);
  Eight3 x(0, 0, 0), way = e.apart;  // a's ball; from it to b's
  if (!centred) {
    Vec3 centre_a[8], centre_b[8];
    for (int k = 0; k < 8; ++k)
      centre_a[k] = b.R[e.a.at[k]] * shapes.ball(pairs.ball_a[e.pair.at[k]]).centre,
      centre_b[k] = b.R[e.b.at[k]] * shapes.ball(pairs.ball_b[e.pair.at[k]]).centre;
    x = load3(centre_a);
    way = e.apart + load3(centre_b) - x;
  }
  const Eight distance = sqrt(squared_norm(way));
  e.overlap = ra + rb - distance;
  e.radius = ra * rb / (ra + rb);
  e.n = (1 / distance) * way;
  e.arm_a = x + (ra - 0.5 * e.overlap) * e.n;
}

template <class Law, bool friction>
void evaluate_balls(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel, bool centred,
                    const Eightfold& awake, Pairs& pairs) {
  EightContacts e;
  e.pair = awake;
  e.a.of(pairs.a.data(), awake), e.b.of(pairs.b.data(), awake);
  find_overlaps(b, shapes, c, pairs, centred, e);
  const unsigned all = (1u << awake.count) - 1, touching = less(0, e.overlap) & all;
  if (touching != all) {
    double beyond[8];
    e.overlap.store(beyond);
    Eightfold rest;
    for (int k = 0; k < awake.count; ++k) {
      const int p = awake.at[k];
      if (touching >> k & 1) {
        rest.add(p);
      } else {
        sleep(travel, -beyond[k], pairs, p);
        release_round(b, c, pairs, p);
      }
    }
    if (rest.count == 0) return;
    rest.complete();
    evaluate_balls<Law, friction>(b, shapes, materials, c, travel, centred, rest, pairs);
    return;
  }
  respond<Law, friction>(b, materials, c, e, pairs);
}

/// Pairs::ball_a, ball_b, radius_a, radius_b.
inline void find_balls(const Bodies& b, const ShapeTable& shapes, Pairs& pairs) {
  for (auto* v : {&pairs.ball_a, &pairs.ball_b}) v->resize(pairs.size());
  for (auto* v : {&pairs.radius_a, &pairs.radius_b}) v->resize(pairs.size());
  for (int p = pairs.begin(PairKind::balls); p < pairs.end(PairKind::points); ++p) {
    pairs.ball_a[p] = shapes.place(b.shape[pairs.a[p]], pairs.part_a[p]);
    pairs.ball_b[p] = shapes.place(b.shape[pairs.b[p]], pairs.part_b[p]);
    pairs.radius_a[p] = shapes.ball(pairs.ball_a[p]).radius;
    pairs.radius_b[p] = shapes.ball(pairs.ball_b[p]).radius;
  }
}

// What pairs need is asked for before it is needed: these are more arrays than the processor follows
// by itself, and it follows none beyond a page. Bodies b lie in no order. First which they are, then
// the rest, which reads that.
inline constexpr int kAhead = 80;  // pairs

[[gnu::always_inline]] inline void fetch_keys(const Pairs& pairs, int p) {
  for (const auto* v : {&pairs.a, &pairs.b, &pairs.ball_b}) fetch_lines(&(*v)[p], 1);
}
[[gnu::always_inline]] inline void fetch_balls(const Bodies& b, const ShapeTable& shapes,
                                               const PairMaterials& materials, bool centred,
                                               const Pairs& pairs, int p) {
  for (const auto* v : {&pairs.arm_a, &pairs.arm_b, &pairs.friction, &pairs.force, &pairs.axis})
    fetch_lines(&(*v)[p], 3);
  for (const auto* v :
       {&pairs.radius_a, &pairs.radius_b, &pairs.friction_stiffness, &pairs.viscous,
        &pairs.viscous_loss, &pairs.normal_force, &pairs.energy, &pairs.friction_energy,
        &pairs.friction_loss, &pairs.area, &pairs.depth, &pairs.stiffness})
    fetch_lines(&(*v)[p], 1);
  for (int k = p; k < p + 8; ++k) {
    const int j = pairs.b[k];
    fetch(b.x[j]), fetch(b.v[j]), fetch(b.turn[j]);
    if (materials.has_damping()) fetch_lines(&b.mass[j], 1), fetch_lines(&b.freedom[j], 1);
    if (materials.materials() > 1) fetch_lines(&b.material[j], 1);
    if (!centred) fetch_lines(&b.R[j], 2), fetch_lines(&shapes.ball(pairs.ball_b[k]), 1);
  }
}
/// At row p of eight, for later ones before `end`. Where this one touches those most likely do;
/// whether they do is not looked at, as another thread may be writing it. One that does not touch
/// asks for what tells that later ones do not either.
[[gnu::always_inline]] inline void fetch_ahead(const Bodies& b, const ShapeTable& shapes,
                                               const PairMaterials& materials,
                                               const std::vector<double>& travel, bool centred,
                                               const Pairs& pairs, int p, int end) {
  if (p + 2 * kAhead + 8 > end) return;
  fetch_keys(pairs, p + 2 * kAhead);
  if (pairs.touching[p]) return fetch_balls(b, shapes, materials, centred, pairs, p + kAhead);
  fetch_lines(&pairs.wake[p + kAhead], 1);
  for (int k = p + kAhead; k < p + kAhead + 8; ++k)
    fetch_lines(&travel[pairs.a[k]], 1), fetch_lines(&travel[pairs.b[k]], 1);
}

/// All pairs of balls of one kind. Those that touch lie in a row, most of them: eight that all do
/// are taken as they lie.
template <class Law, bool friction>
void evaluate_ball_pairs(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                         const StepContext& c, const std::vector<double>& travel, PairKind kind,
                         Pairs& pairs) {
  const int begin = pairs.begin(kind), end = pairs.end(kind);
  if (begin == end) return;
  if (pairs.ball_a.empty()) find_balls(b, shapes, pairs);
  const int stretch = stretch_of(end - begin), stretches = (end - begin + stretch - 1) / stretch;
  const bool centred = kind == PairKind::balls, many = end - begin > kManyPairs;
  const int threads = c.threads_for(end - begin);
  const int busy = (pairs.busy_end(kind) - begin + stretch - 1) / stretch;
  by_shares(stretches, busy, threads, [&](int s, int) {
    const auto evaluate = [&](const Eightfold& e) {
      evaluate_balls<Law, friction>(b, shapes, materials, c, travel, centred, e, pairs);
    };
    Eightfold awake;
    const int first = begin + s * stretch, last = std::min(end, first + stretch);
    for (int row = first; row < last; row += 8) {
      if (many) fetch_ahead(b, shapes, materials, travel, centred, pairs, row, end);
      if (row + 8 <= last && all_are(&pairs.touching[row], 1)) {
        evaluate(Eightfold::row(row, 8));
        continue;
      }
      for (int p = row; p < std::min(last, row + 8); ++p) {
        if (asleep(travel, pairs, p)) continue;
        awake.add(p);
        if (awake.count < 8) continue;
        awake.complete();
        evaluate(awake);
        awake.count = 0;
      }
    }
    if (awake.count == 0) return;
    awake.complete();
    evaluate(awake);
  });
}

}  // namespace trackbed::dem
