// The loops over pairs of balls, spheres on polyhedra, dilated polyhedra, for one law, with or
// without friction. Included by the file that makes the instances, nowhere else.
#pragma once
#include "dem/contact/ball_features.h"
#include "dem/contact/release.h"
#include "dem/contact/round_forces.h"
#include "dem/contact/round_response.h"

namespace trackbed::dem {

/// 1/(1/a + 1/b); 0 is flat.
inline double mean_radius(double a, double b) { return b > 0 && a > 0 ? a * b / (a + b) : a + b; }

// One a kind of pair: the deepest balls relative to body a's centre; `apart` is b's centre there.

struct BallsGeometry {
  static constexpr PairKind kind = PairKind::balls;
  static DeepestBalls find(const Bodies&, const PartView& a, const PartView& b, const Vec3& apart,
                           Pairs&, int) {
    const double distance = apart.norm();
    return {
        Vec3::Zero(), apart, a.radius, b.radius, apart / distance, a.radius + b.radius - distance};
  }
};

struct PointsGeometry {
  static constexpr PairKind kind = PairKind::points;
  static DeepestBalls find(const Bodies& bodies, const PartView& a, const PartView& b,
                           const Vec3& apart, Pairs& pairs, int p) {
    const Vec3 x = bodies.R[pairs.a[p]] * a.centre, y = apart + bodies.R[pairs.b[p]] * b.centre;
    const Vec3 way = y - x;
    const double distance = way.norm();
    return {x, y, a.radius, b.radius, way / distance, a.radius + b.radius - distance};
  }
};

struct PointCoreGeometry {
  static constexpr PairKind kind = PairKind::point_core;
  static DeepestBalls find(const Bodies& bodies, const PartView& a, const PartView& b,
                           const Vec3& apart, Pairs& pairs, int p) {
    return deepest_balls(bodies.R[pairs.a[p]] * a.centre, a.radius, b,
                         {bodies.R[pairs.b[p]], apart});
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

/// What damping still took while the contact opened.
inline void release_round(const Bodies& b, const StepContext& c, Pairs& pairs, int p) {
  if (!pairs.touching[p] && pairs.friction_loss[p] == 0 && pairs.viscous_loss[p] == 0) return;
  double loss = 0;
  if (pairs.touching[p] && pairs.viscous[p] != 0 && c.dt > 0) {
    const int i = pairs.a[p], j = pairs.b[p];
    const ContactSlip slip = contact_slip(c.dt, b.v[i], b.turn[i], pairs.arm_a[p], pairs.arm_a[p],
                                          b.v[j], b.turn[j], pairs.arm_b[p], pairs.arm_b[p]);
    // It opened somewhere within the step: at most what the spring still held.
    const double way = pairs.axis[p].dot(slip.displacement);
    const double held = std::max(-pairs.depth[p], std::min(0.0, way));
    loss = pairs.viscous[p] * held / 2;
  }
  release(pairs, p);
  pairs.viscous[p] = 0;
  pairs.viscous_loss[p] = loss;
}

template <class Geometry, class Law, bool friction>
void evaluate_round_pair(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                         const StepContext& c, const std::vector<double>& travel, Pairs& pairs,
                         int p) {
  const int i = pairs.a[p], j = pairs.b[p];
  const PartView& part_a = shapes.part(b.shape[i], pairs.part_a[p]);
  const PartView& part_b = shapes.part(b.shape[j], pairs.part_b[p]);
  const Vec3 apart = b.x[j] + nearest_image(b.x[i], b.x[j], c.period) - b.x[i];
  const DeepestBalls balls = Geometry::find(b, part_a, part_b, apart, pairs, p);
  const Vec3 arm_a = balls.x + (balls.ra - balls.overlap / 2) * balls.n;
  if (!(balls.overlap > 0)) {
    pairs.wake[p] = travel[i] + travel[j] - balls.overlap;
    release_round(b, c, pairs, p);
    pairs.arm_a[p] = arm_a;
    return;
  }
  const bool old = pairs.touching[p];
  const Vec3 arm_b = arm_a - apart, old_a = old ? pairs.arm_a[p] : arm_a,
             old_b = old ? pairs.arm_b[p] : arm_b;
  ContactSlip slip{Vec3::Zero(), Vec3::Zero()};
  if (c.dt > 0)
    slip = contact_slip(c.dt, b.v[i], b.turn[i], old_a, arm_a, b.v[j], b.turn[j], old_b, arm_b);
  const double way = balls.n.dot(slip.displacement);

  BallContact contact;
  contact.overlap = balls.overlap;
  contact.radius = mean_radius(part_a.radius, part_b.radius);
  contact.rate = c.dt > 0 ? way / c.dt : 0;
  contact.mass = b.freedom[j] == kFixed   ? b.mass[i]
                 : b.freedom[i] == kFixed ? b.mass[j]
                                          : b.mass[i] * b.mass[j] / (b.mass[i] + b.mass[j]);
  contact.dt = c.dt;
  const PairMaterial& material = materials(b.material[i], b.material[j]);
  const double force = respond<Law, friction>(material, contact, balls.n, slip, pairs, p);
  pairs.axis[p] = balls.n;
  pairs.arm_a[p] = arm_a;
  pairs.arm_b[p] = arm_b;
  pairs.couple[p].setZero();
  if constexpr (Geometry::kind == PairKind::cores)
    // A crowned face rolls: the contact moves by its radius of curvature.
    pairs.tilt_stiffness[p] = force / (part_a.crown + part_b.crown);
}

template <class Geometry, class Law, bool friction>
void evaluate_kind(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                   const StepContext& c, const std::vector<double>& travel, Pairs& pairs) {
  const int begin = pairs.begin(Geometry::kind), end = pairs.end(Geometry::kind);
  if (begin == end) return;
#pragma omp parallel for schedule(dynamic, 64) num_threads(c.threads) if (c.threads > 1)
  for (int p = begin; p < end; ++p) {
    if (travel[pairs.a[p]] + travel[pairs.b[p]] < pairs.wake[p]) {
      pairs.friction_loss[p] = pairs.viscous_loss[p] = 0;
      continue;
    }
    evaluate_round_pair<Geometry, Law, friction>(b, shapes, materials, c, travel, pairs, p);
  }
}

template <class Law, bool friction>
void evaluate_round(const Bodies& b, const ShapeTable& shapes, const PairMaterials& materials,
                    const StepContext& c, const std::vector<double>& travel, Pairs& pairs) {
  evaluate_kind<BallsGeometry, Law, friction>(b, shapes, materials, c, travel, pairs);
  evaluate_kind<PointsGeometry, Law, friction>(b, shapes, materials, c, travel, pairs);
  evaluate_kind<PointCoreGeometry, Law, friction>(b, shapes, materials, c, travel, pairs);
  evaluate_kind<CoresGeometry, Law, friction>(b, shapes, materials, c, travel, pairs);
}

}  // namespace trackbed::dem
