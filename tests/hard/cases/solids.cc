// Bodies that break codes by their form, or by lying in one another: slivers, needles, faces of a
// millionth, corners given twice or inside a face; half, full and whole overlap. No damping.
#include <Eigen/Eigenvalues>

#include "base/error.h"
#include "dem/motion/monitor.h"
#include "grain_scene.h"

namespace trackbed::hard {
namespace {

using dem::Mat3;
using dem::Polyhedron;
using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e8;

// A thin solid with its volume and principal moments by hand.
struct Thin {
  Polyhedron body;
  double volume;
  Vec3 inertia;  ///< ascending, at density 1
};

Thin thin_box(double a, double b, double c) {
  const long double v = (long double)a * b * c;
  Vec3 inertia(v * (b * b + c * c) / 12, v * (a * a + c * c) / 12, v * (a * a + b * b) / 12);
  std::sort(inertia.data(), inertia.data() + 3);
  return {dem::make_box({a, b, c}), double(v), inertia};
}

// Corner at the origin, legs a, b, c along the axes: of the covariance V/20 (sum p p^T + s s^T)
// less V s s^T/16 about the centroid, s the sum of corners.
Thin thin_tetrahedron(double a, double b, double c) {
  const long double v = (long double)a * b * c / 6;
  const Vec3 s(a, b, c);
  const Mat3 covariance = double(v) * (Mat3(s.cwiseProduct(s).asDiagonal()) / 20 +
                                       s * s.transpose() * (1 / 20. - 1 / 16.));
  const Mat3 inertia = covariance.trace() * Mat3::Identity() - covariance;
  return {dem::convex_hull({{0, 0, 0}, {a, 0, 0}, {0, b, 0}, {0, 0, c}}), double(v),
          Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvalues()};
}

// A square pyramid of base 1 and height h cut off where its section is `top` wide: sections a(z)^2,
// a^4/12 about their middles.
Thin cut_pyramid(double top, double h) {
  const long double q = top, slope = (1 - q) / h;
  const auto power = [&](int n) {  // int a^n dz
    return (1 - std::pow(q, (long double)(n + 1))) / ((n + 1) * slope);
  };
  const long double v = power(2);
  // z = (1 - a)/slope.
  const long double first = (power(2) - power(3)) / slope,
                    second = (power(2) - 2 * power(3) + power(4)) / (slope * slope);
  const long double upright = power(4) / 6, across = power(4) / 12 + second - first * first / v;
  std::vector<Vec3> corners;
  for (const double x : {-.5, .5})
    for (const double y : {-.5, .5})
      corners.push_back({x, y, 0}), corners.push_back({x * top, y * top, h});
  Vec3 inertia(upright, across, across);
  std::sort(inertia.data(), inertia.data() + 3);
  return {dem::convex_hull(corners, 1e-12), double(v), inertia};
}

// Wherever it stands and however it is turned.
Measured masses(const Setting&) {
  double worst = 0;
  for (const Thin& thin : {thin_box(1, 1e-3, 1e-3), thin_box(1, 1, 1e-3), thin_box(1, .1, 1e-3),
                           thin_tetrahedron(1, 1, 1e-3), thin_tetrahedron(1, 1e-3, 1e-3),
                           cut_pyramid(1e-6, 1), cut_pyramid(1e-3, 2)})
    for (const double angle : {0., .7}) {
      Polyhedron body = thin.body;
      const Quat q = dem::turn_about({1, 2, .5}, angle);
      for (Vec3& p : body.vertices) p = kSize * (q * p + 3 * angle * Vec3(1, -1, 1));
      const dem::GrainShape g = dem::make_grain_shape(body);
      if (!(g.inertia.minCoeff() > 0)) return {HUGE_VAL, 1e-9};
      worst = std::max(worst, std::abs(g.volume / (std::pow(kSize, 3) * thin.volume) - 1));
      for (int d = 0; d < 3; ++d)
        worst =
            std::max(worst, std::abs(g.inertia[d] / (std::pow(kSize, 5) * thin.inertia[d]) - 1));
    }
  return {worst, 1e-9};
}

// Needles ten times as thin, t: the spring goes with sqrt(t), their least inertia with t^4, so that
// a step from it falls by t^(7/4); one from the mass would fall by t^(3/4).
Measured step_of_needle(const Setting&) {
  const auto step = [](double t) {
    Scene s(kModulus, .5);
    s.add(dem::make_grain_shape(dem::make_box(kSize * Vec3(1, t, t))), 2600, Vec3::Zero());
    return dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  };
  return {std::abs(step(1e-3) / step(1e-2) * std::pow(10, 1.75) - 1), .01};
}

// Thrown at the floor, slanted.
Measured thrown_sliver(const Setting& set) {
  double worst = -1;
  for (const Vec3& edges : {Vec3(1, 1e-3, 1e-3), Vec3(1, 1, 1e-3)}) {
    Scene s(kModulus, .5, set.law);
    s.context.gravity.setZero();
    const Quat q = dem::turn_about({1, 2, .5}, .4);
    const dem::GrainShape g = dem::make_grain_shape(dem::make_box(kSize * edges));
    s.add(g, 2600, Vec3::Zero(), q);
    double low = 0;
    for (const Vec3& p : g.body.vertices) low = std::min(low, (q * p).z());
    s.bodies.x[0].z() = -low + 1e-6 * kSize;
    s.add_floor(1, .1);
    s.bodies.v[0] = {.02, 0, -.1};
    s.prepare();
    s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
    const double before = s.now().kinetic;
    bool touched = false;
    for (int k = 0, away = 0; k < 100000 && away < 100; ++k) {
      s.step();
      const bool now = dem::count_contacts(s.pairs) > 0;
      touched |= now;
      away = touched && !now ? away + 1 : 0;
    }
    if (!touched) return {HUGE_VAL, 1e-3};
    worst = std::max(worst, s.now().kinetic / before - 1);
  }
  return {worst, 1e-3, conservative(set)};
}

// The solid's corners with others that say nothing new: twice the same, inside edges and faces, on
// them to within rounding.
std::vector<Vec3> with_spare_corners(const Polyhedron& body) {
  std::vector<Vec3> p = body.vertices;
  const std::size_t own = p.size();
  for (std::size_t k = 0; k < own; ++k) p.push_back(p[k]);
  for (const auto& face : body.faces) {
    Vec3 middle = Vec3::Zero(), normal = Vec3::Zero();
    for (std::size_t k = 0; k < face.size(); ++k) {
      const Vec3 a = p[face[k]], b = p[face[(k + 1) % face.size()]];
      middle += a / double(face.size()), normal += a.cross(b);
      p.push_back(.5 * (a + b)), p.push_back(.7 * a + .3 * b);
    }
    normal.normalize();
    const Vec3 aside = .1 * (p[face[0]] - middle);
    for (const double off : {0., 1e-13, -1e-13, 1e-11, -1e-11})
      p.push_back(middle + (1 + 1e11 * off) * aside + off * kSize * normal);
  }
  return p;
}

Measured spare_corners(const Setting& set) {
  const Polyhedron plain = solid(set.shape, kSize);
  const dem::GrainShape a = dem::make_grain_shape(plain),
                        b = dem::make_grain_shape(dem::convex_hull(with_spare_corners(plain)));
  double worst = std::max(std::abs(b.volume / a.volume - 1),
                          (b.inertia - a.inertia).norm() / a.inertia.norm());
  const auto force = [&](const dem::GrainShape& g) {
    Scene s(kModulus, 0, set.law);
    const Quat q = dem::turn_about({1, 2, .5}, .9);
    s.add(g, 2600, q * g.origin, q * g.turn);
    double low = 0;
    for (const Vec3& p : plain.vertices) low = std::min(low, (q * p).z());
    s.bodies.x[0].z() -= low + .01 * kSize;
    s.add_floor(1, 1);
    s.prepare();
    return s.bodies.force[0];
  };
  const Vec3 f = force(a);
  return {std::max(worst, (force(b) - f).norm() / f.norm()), 1e-12};
}

// Two of a kind, the second nearer and nearer to the first's centre, until the run is refused. 1 if
// the force turns round before, if they leave with more than was stored, or if nothing refuses one
// at the other's centre.
Measured one_in_another(const Setting& set) {
  const Vec3 way = Vec3(.3, .2, 1).normalized();
  const dem::GrainShape g = grain(set.shape, kSize);
  const bool stores = is_round(set) || set.law != "shao2017";
  int touched = 0;
  for (int k = 200; k >= 0; --k) {
    Scene s = scene_of(set, kModulus, 0, kSize);
    s.context.gravity.setZero();
    s.add(g, 2600, Vec3::Zero(), g.turn);
    s.add(g, 2600, k / 100. * g.radius * way, dem::turn_about({1, 1, 3}, .3) * g.turn);
    s.prepare();
    s.context.dt = .02 * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
    if (dem::count_contacts(s.pairs) == 0) continue;
    try {
      dem::check_state(s.bodies, s.shapes, s.pairs, s.context, 0);
    } catch (const RunError&) {
      return {0, 0};  // refused from here on
    }
    if (!(s.bodies.force[1].dot(s.bodies.x[1] - s.bodies.x[0]) > 0)) return {1, 0};
    if (touched++ % 8 || !stores) continue;
    const double stored = s.start.normal;
    for (int j = 0; j < 20000 && dem::count_contacts(s.pairs) > 0; ++j) s.step();
    if (s.now().kinetic > (1 + 1e-3) * stored) return {1, 0};
  }
  return {1, 0};
}

// A grain a fifth as large inside: refused wherever it lies.
Measured contained(const Setting& set) {
  for (const Vec3& off : {Vec3(0, 0, 0), Vec3(.01, 0, 0), Vec3(0, .01, -.01)}) {
    Scene s = scene_of(set, kModulus, 0, kSize);
    const dem::GrainShape outer = grain(set.shape, kSize), inner = grain(set.shape, .02 * kSize);
    // A clump's spheres leave a hole in the middle: into one of them.
    const Vec3 middle = set.shape == "clump" ? outer.parts[0].core.vertices[0] : Vec3(0, 0, 0);
    s.add(outer, 2600, Vec3::Zero());
    s.add(inner, 2600, middle + .02 * off);
    s.context.dt = 1e-6;
    s.prepare();
    try {
      dem::check_state(s.bodies, s.shapes, s.pairs, s.context, 0);
      return {1, 0};
    } catch (const RunError&) {
    }
  }
  return {0, 0};
}

// Faces or feet that touch without overlap, no load, no speed: 0/0 waits in every normal.
Measured no_load(const Setting& set) {
  Scene s = scene_of(set, kModulus, .5, kSize);
  s.context.gravity.setZero();
  const dem::GrainShape g = grain(set.shape, kSize);
  double low = g.radius;
  if (!is_round(set)) {
    low = 0;
    for (const Vec3& p : g.body.vertices) low = std::max(low, -(g.turn * p).z());
  }
  s.add(g, 2600, {0, 0, low}, g.turn);
  s.add_floor(1, 1);
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  for (int k = 0; k < 100; ++k) s.step();
  const double speed = s.bodies.v[0].norm() + s.bodies.omega[0].norm() * kSize;
  return {std::isfinite(speed) ? speed : HUGE_VAL, 1e-10};
}

}  // namespace

const std::vector<Case>& solid_cases() {
  static const std::vector<Case> cases{
      {"slivers and needles 1:10^3, a face of 1e-6", "volume and moments, least one positive",
       "relative difference", "none", Over::once, false, false, masses},
      {"needles 1:10^2 and 1:10^3: the step", "comes from the least inertia", "relative difference",
       "none", Over::once, false, false, step_of_needle},
      {"needle and flake 1:10^3 thrown at the floor", "no kinetic energy is gained",
       "share of the energy before", "none", Over::pair_laws, true, false, thrown_sliver},
      {"spare corners: twice, inside faces, nearly coplanar", "the same volume, moments and force",
       "relative difference", "none", Over::shapes, false, false, spare_corners},
      {"half and full overlap", "pushed apart, or the run is refused", "1 = drawn in", "none",
       Over::all_shapes, false, false, one_in_another},
      {"a small grain inside a large one", "the run is refused", "1 = unseen", "none",
       Over::all_shapes, false, false, contained},
      {"touching without load", "stays at rest, no 0/0", "m/s", "none", Over::all_shapes, false,
       false, no_load}};
  return cases;
}

}  // namespace trackbed::hard
