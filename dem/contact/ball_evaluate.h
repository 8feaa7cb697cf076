// The loop over pairs of balls, spheres and those of clumps: eight pairs at a time, one law, with
// or without friction. Included by the file that makes the instances, nowhere else.
#pragma once
#include "dem/contact/eight_contacts.h"
#include "dem/contact/fetch.h"
#include "dem/contact/round_release.h"

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
  double radius[2][8];
  Vec3 centre[2][8];
  for (int k = 0; k < 8; ++k) {
    const int p = e.pair.at[k], i = e.a.at[k], j = e.b.at[k];
    const Ball &u = shapes.ball(b.shape[i], pairs.part_a[p]),
               &v = shapes.ball(b.shape[j], pairs.part_b[p]);
    radius[0][k] = u.radius, radius[1][k] = v.radius;
    if (!centred) centre[0][k] = b.R[i] * u.centre, centre[1][k] = b.R[j] * v.centre;
  }
  const Eight ra = Eight::load(radius[0]), rb = Eight::load(radius[1]);
  Eight3 x(0, 0, 0), way = e.apart;  // a's ball; from it to b's
  if (!centred) {
    x = load3(centre[0]);
    way = e.apart + load3(centre[1]) - x;
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
                    Eightfold awake, Pairs& pairs) {
  awake.complete();
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
    if (rest.count > 0)
      evaluate_balls<Law, friction>(b, shapes, materials, c, travel, centred, rest, pairs);
    return;
  }
  respond<Law, friction>(b, materials, c, e, pairs);
}

/// Bodies at b lie in no order: they are asked for before they are needed.
[[gnu::always_inline]] inline void fetch_ball(const Bodies& b, const ShapeTable& shapes, int i) {
  for (const Vec3* at : {&b.x[i], &b.v[i], &b.turn[i]}) fetch_lines(at, 1);
  fetch_lines(&shapes.ball(b.shape[i], 0), 1);
}
inline constexpr int kAhead = 20;  // pairs

/// All pairs of balls of one kind.
template <class Law, bool friction>
void evaluate_ball_pairs(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                         const StepContext& c, const std::vector<double>& travel, PairKind kind,
                         Pairs& pairs) {
  const int begin = pairs.begin(kind), end = pairs.end(kind);
  const int stretches = (end - begin + kStretch - 1) / kStretch;
  const bool centred = kind == PairKind::balls;
  const int threads = c.threads_for(end - begin);  // a pair takes no longer than a body
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
  for (int s = 0; s < stretches; ++s) {
    Eightfold awake;
    const auto evaluate = [&] {
      evaluate_balls<Law, friction>(b, shapes, materials, c, travel, centred, awake, pairs);
      awake.count = 0;
    };
    for (int p = begin + s * kStretch; p < std::min(end, begin + (s + 1) * kStretch); ++p) {
      if (p + kAhead < end) fetch_ball(b, shapes, pairs.b[p + kAhead]);
      if (asleep(travel, pairs, p)) continue;
      awake.add(p);
      if (awake.count == 8) evaluate();
    }
    if (awake.count > 0) evaluate();
  }
}

}  // namespace trackbed::dem
