// The loops over spheres on polyhedra and over dilated polyhedra, for one law, with or without
// friction; those over pairs of balls are in ball_evaluate.h. Included by the file that makes the
// instances, nowhere else.
#pragma once
#include "dem/contact/ball_evaluate.h"
#include "dem/contact/ball_features.h"
#include "dem/contact/flat_response.h"
#include "dem/contact/round_forces.h"

namespace trackbed::dem {

// One a kind of pair: the deepest balls relative to body a's centre; `apart` is b's centre there.

struct PointCoreGeometry {
  static constexpr PairKind kind = PairKind::point_core;
  static DeepestBalls find(const Bodies& bodies, const PartView& a, const PartView& b,
                           const Vec3& apart, Pairs& pairs, int p) {
    return deepest_balls(bodies.R[pairs.a[p]] * a.centre, a.radius, b,
                         {bodies.R[pairs.b[p]], apart}, pairs.faces_b[p]);
  }
};

struct CoresGeometry {
  static constexpr PairKind kind = PairKind::cores;
  static DeepestBalls find(const Bodies& bodies, const PartView& a, const PartView& b,
                           const Vec3& apart, Pairs& pairs, int p) {
    const Mat3& Ra = bodies.R[pairs.a[p]];
    const Pose pose{bodies.R[pairs.b[p]], apart};
    DeepestBalls balls;
    if (deepest_balls_again(a, Ra, b, pose, CoreFeature::of(pairs.faces_a[p]),
                            CoreFeature::of(pairs.faces_b[p]), balls))
      return balls;
    balls = deepest_balls(a, Ra, b, pose, pairs.arm_a[p], pairs.axis[p]);
    pairs.faces_a[p] = balls.on_a, pairs.faces_b[p] = balls.on_b;
    return balls;
  }
};

/// Contacts found one by one, until there are eight.
struct Found {
  Eightfold pair;
  double overlap[8], radius[8];
  Vec3 n[8], arm_a[8], apart[8];

  EightContacts eight(const Pairs& pairs) {
    for (int k = pair.count; k < 8; ++k)
      overlap[k] = overlap[0], radius[k] = radius[0], n[k] = n[0], arm_a[k] = arm_a[0],
      apart[k] = apart[0];
    pair.complete();
    EightContacts e;
    e.pair = pair;
    e.a.of(pairs.a.data(), pair), e.b.of(pairs.b.data(), pair);
    e.overlap = Eight::load(overlap), e.radius = Eight::load(radius);
    e.n = load3(n), e.arm_a = load3(arm_a), e.apart = load3(apart);
    return e;
  }
};

/// Dilated polyhedra on each other or on plain ones, under a law that knows of their flat faces.
template <class Geometry, class Law>
inline constexpr bool kFlats = Geometry::kind == PairKind::cores&& Law::flats;

/// The part as that law and kind of pair see it.
template <class Geometry, class Law>
const PartView& part_of(const ShapeTable& shapes, int shape, int k) {
  if constexpr (kFlats<Geometry, Law>) return shapes.flat_part(shape, k);
  return shapes.part(shape, k);
}

/// Adds pair p to `found` if it touches; one with flat parts answers at once.
template <class Geometry, class Law, bool friction>
void find_contact(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                  const StepContext& c, const std::vector<double>& travel, OverlapWorkspace& work,
                  Pairs& pairs, int p, Found& found) {
  const int i = pairs.a[p], j = pairs.b[p];
  const PartView& part_a = part_of<Geometry, Law>(shapes, b.shape[i], pairs.part_a[p]);
  const PartView& part_b = part_of<Geometry, Law>(shapes, b.shape[j], pairs.part_b[p]);
  const Vec3 apart = b.x[j] + nearest_image(b.x[i], b.x[j], c.period) - b.x[i];
  const DeepestBalls balls = Geometry::find(b, part_a, part_b, apart, pairs, p);
  const Vec3 arm_a = balls.x + (balls.ra - balls.overlap / 2) * balls.n;
  if (!(balls.overlap > 0)) {
    sleep(travel, -balls.overlap, pairs, p);
    release_round(b, c, pairs, p);
    pairs.arm_a[p] = arm_a;
    return;
  }
  const double radius = mean_radius(part_a.radius, part_b.radius);
  if constexpr (kFlats<Geometry, Law>) {
    const PairMaterial& material = materials(b.material[i], b.material[j]);
    NormalContact flat;
    if (flat_contact(part_a, b.R[i], part_b, {b.R[j], apart}, balls, material, work, flat)) {
      const BallContactOf<double> contact{balls.overlap, radius, 0, contact_mass(b, i, j), c.dt};
      respond_flat<Law, friction>(b, material, contact, balls.n, arm_a, flat,
                                  part_a.crown + part_b.crown, apart, pairs, p);
      return;
    }
    pairs.couple[p].setZero();  // of a flat part that is gone
  }
  const int k = found.pair.count;
  found.pair.add(p);
  found.overlap[k] = balls.overlap;
  found.radius[k] = radius;
  found.n[k] = balls.n, found.arm_a[k] = arm_a, found.apart[k] = apart;
}

template <class Geometry, class Law, bool friction>
void respond_to(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                const StepContext& c, Pairs& pairs, Found& found) {
  const Eight force = respond<Law, friction>(b, materials, c, found.eight(pairs), pairs);
  if constexpr (Geometry::kind == PairKind::cores) {
    // A crowned face rolls: the contact moves by its radius of curvature.
    double forces[8];
    force.store(forces);
    for (int k = 0; k < found.pair.count; ++k) {
      const int p = found.pair.at[k];
      pairs.tilt_stiffness[p] =
          forces[k] / (part_of<Geometry, Law>(shapes, b.shape[pairs.a[p]], pairs.part_a[p]).crown +
                       part_of<Geometry, Law>(shapes, b.shape[pairs.b[p]], pairs.part_b[p]).crown);
    }
  }
  found.pair.count = 0;
}

template <class Geometry, class Law, bool friction>
void evaluate_kind(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                   const StepContext& c, const std::vector<double>& travel, Pairs& pairs) {
  const int begin = pairs.begin(Geometry::kind), end = pairs.end(Geometry::kind);
  if (begin == end) return;
  if (static_cast<int>(pairs.workspaces.size()) < c.threads) pairs.workspaces.resize(c.threads);
  const int stretch = stretch_of(end - begin), stretches = (end - begin + stretch - 1) / stretch;
  const int busy = (pairs.busy_end(Geometry::kind) - begin + stretch - 1) / stretch;
  // A sphere on a polyhedron takes as long as two bodies are moved.
  constexpr bool quick = Geometry::kind == PairKind::point_core;
  const int threads = quick ? c.threads_for(2 * (end - begin)) : c.threads;
  by_shares(stretches, busy, threads, [&](int s, int t) {
    Found found;
    for (int p = begin + s * stretch; p < std::min(end, begin + (s + 1) * stretch); ++p) {
      if (asleep(travel, pairs, p)) continue;
      find_contact<Geometry, Law, friction>(b, shapes, materials, c, travel, pairs.workspaces[t],
                                            pairs, p, found);
      if (found.pair.count == 8)
        respond_to<Geometry, Law, friction>(b, shapes, materials, c, pairs, found);
    }
    if (found.pair.count > 0)
      respond_to<Geometry, Law, friction>(b, shapes, materials, c, pairs, found);
  });
}

template <class Law, bool friction>
void evaluate_round(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel, Pairs& pairs) {
  evaluate_ball_pairs<Law, friction>(b, shapes, materials, c, travel, PairKind::balls, pairs);
  evaluate_ball_pairs<Law, friction>(b, shapes, materials, c, travel, PairKind::points, pairs);
  evaluate_kind<PointCoreGeometry, Law, friction>(b, shapes, materials, c, travel, pairs);
  evaluate_kind<CoresGeometry, Law, friction>(b, shapes, materials, c, travel, pairs);
}

}  // namespace trackbed::dem
