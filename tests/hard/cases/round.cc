// Spheres, clumps and dilated polyhedra (faces without a crown, so that a corner is a ball) at
// rest, held on a path, over edges and corners.
#include <functional>
#include <utility>
#include <vector>

#include "on_a_floor.h"

namespace trackbed::hard {
namespace {

using dem::Quat;
using dem::Scene;
using dem::Vec3;

constexpr double kSize = .1, kModulus = 1e8;

// Sphere that is lowest when the grain stands on one of its corners: radius, depth of its centre
// below the grain's.
struct Foot {
  double radius, below;
};
Foot foot(const std::string& shape) {
  if (shape == "sphere") return {kSize / 2, 0};
  if (shape == "clump") return {.3 * kSize, .2 * std::sqrt(3.) * kSize};
  return {kSize / 4, .25 * std::sqrt(3.) * kSize};
}

// On one corner, that foot's centre at x, on a floor that is `base` wide in all.
Scene standing(const Setting& set, double mu, const Vec3& x, double base = 2,
               std::uint8_t freedom = dem::kFree, double crown = 0) {
  Scene s = scene_of(set, kModulus, mu, kSize);
  const dem::GrainShape g = grain(set.shape, kSize, crown);
  const Quat q = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, -1));
  dem::add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, 2600,
                 x + Vec3(0, 0, foot(set.shape).below) + q * g.origin, q * g.turn, freedom);
  s.add_floor(base, 1);
  s.prepare();
  return s;
}

// Force of the law for that overlap, by hand: Hertz 4/3 E sqrt(R) d^1.5 (Sun's too), linear k d.
double force_of(const Setting& set, double depth) {
  if (set.law == "linear") return kModulus * kSize * depth;
  return 4. / 3 * kModulus * std::sqrt(foot(set.shape).radius) * std::pow(depth, 1.5);
}

Vec3 at_depth(const Setting& set, double depth) { return {0, 0, foot(set.shape).radius - depth}; }

Measured force_is_the_laws(const Setting& set) {
  double worst = 0;
  for (const double depth : {1e-9, 1e-6, 1e-3, 1e-2}) {
    const double d = depth * kSize, f = standing(set, 0, at_depth(set, d)).bodies.force[0].z();
    worst = std::max(worst, std::abs(f / force_of(set, d) - 1) * std::min(1., depth / 1e-6));
  }
  return {worst, 1e-6};
}

// A tenth out of balance: depth that carries the weight, by the law (sun2015 sinks in less).
Measured at_rest(const Setting& set) {
  const double weight_of_all = 9.81 * standing(set, 0, at_depth(set, 0)).bodies.mass[0];
  const double power = set.law == "linear" ? 1 : 1.5;
  const double balance = std::pow(weight_of_all / force_of(set, 1), 1 / power);
  Scene s = standing(set, .5, at_depth(set, 1.1 * balance), 2, dem::kMoveZ, .02);
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  s.context.local_damping = .5;
  for (int k = 0; k < 20000; ++k) s.step();
  const double weight = 9.81 * s.bodies.mass[0];
  return {std::abs(s.bodies.force[0].z() / weight - 1), 1e-8};
}

Measured toggles(const Setting& set) {
  const Scene s = standing(set, .5, at_depth(set, -1e-9 * kSize), 2, dem::kMoveZ);
  return {changes_of_contact(s, set, 1e-3, s.bodies.x[0].z() + 1e-6, 200000), 2};
}

// Where a piecewise constant function changes its value, and `to`: there the foot's point leaves a
// corner for an edge or a face, and the force has a kink. An integral over a kink is no measure of
// a law: two estimates of a rule may agree there by chance (hertz_flat: to 1e-15 of U, both wrong
// by 2e-10; 7e-14 are left between the kinks).
template <class F>
std::vector<double> changes(F&& f, double from, double to) {
  constexpr int parts = 256;
  std::vector<double> places;
  double low = from;
  for (int k = 1; k <= parts; ++k) {
    const double high = from + k * (to - from) / parts;
    const auto after = f(high);
    for (auto before = f(low); before != after; before = f(low)) {  // one change after the other
      double a = low, b = high;
      while (b - a > 1e-13 * (to - from)) {
        const double middle = (a + b) / 2;
        (f(middle) == before ? a : b) = middle;
      }
      places.push_back(low = b);
    }
    low = high;
  }
  places.push_back(to);
  return places;
}

// By Gauss's rule of five points, in halves until these agree.
double integral(const std::function<double(double)>& f, double from, double to, double tolerance) {
  static constexpr double at[3] = {0, .5384693101056831, .9061798459386640},
                          weight[3] = {.5688888888888889, .4786286704993665, .2369268850561891};
  const auto gauss = [&](double a, double b) {
    const double middle = (a + b) / 2, half = (b - a) / 2;
    double sum = weight[0] * f(middle);
    for (int k = 1; k < 3; ++k)
      sum += weight[k] * (f(middle - half * at[k]) + f(middle + half * at[k]));
    return half * sum;
  };
  const std::function<double(double, double, double)> refined = [&](double a, double b,
                                                                    double whole) {
    const double middle = (a + b) / 2, left = gauss(a, middle), right = gauss(middle, b);
    if (std::abs(left + right - whole) <= tolerance || b - a < 1e-9) return left + right;
    return refined(a, middle, left) + refined(middle, b, right);
  };
  double sum = 0;
  const int parts = 8;
  for (int k = 0; k < parts; ++k) {
    const double a = from + k * (to - from) / parts, b = from + (k + 1) * (to - from) / parts;
    sum += refined(a, b, gauss(a, b));
  }
  return sum;
}

// Held beyond the rim of the floor, leaning on its edge or its corner: a circle in x and z.
double work_of_a_circle(const Setting& set, bool corner) {
  const double base = .45 * kSize, r = 1e-3 * kSize, reach = foot(set.shape).radius * .7;
  const Vec3 middle(base + reach, corner ? base + .3 * reach : 0, 0);
  // At that height the foot overlaps the edge by twice the circle's radius.
  const double across = std::hypot(reach, corner ? .3 * reach : 0);
  const double up = std::sqrt(std::pow(foot(set.shape).radius - 2 * r, 2) - across * across);
  Scene s = standing(set, 0, middle + Vec3(0, 0, up), base);
  const Vec3 centre = s.bodies.x[0];
  const double scale = s.now().normal;
  double stored = 0;
  const auto go_to = [&](double a) {
    s.bodies.x[0] = centre + r * Vec3(std::cos(a), 0, std::sin(a));
    s.prepare();
    stored = std::max(stored, s.now().normal);
  };
  const auto power = [&](double a) {
    go_to(a);
    return r * s.bodies.force[0].dot(Vec3(-std::sin(a), 0, std::cos(a)));
  };
  const auto features = [&](double a) {
    go_to(a);
    return s.pairs.size() ? std::pair(s.pairs.faces_a[0], s.pairs.faces_b[0]) : std::pair(0, 0);
  };
  double work = 0, from = 0;
  for (const double to : changes(features, 0, 2 * M_PI))
    work += integral(power, from, to, 1e-13 * scale), from = to;
  return stored > 0 ? std::abs(work) / stored : HUGE_VAL;
}
Measured closed_path(const Setting& set) {
  return {std::max(work_of_a_circle(set, false), work_of_a_circle(set, true)), 1e-10};
}

// Across the rim, where the foot's point leaves the face for the edge: force before and after.
Measured across_an_edge(const Setting& set) {
  const double base = .45 * kSize;
  double worst = 0;
  for (const double y : {0., base}) {
    const auto force = [&](double past) {
      const double side = y > 0 ? y + past : 0;
      return standing(set, 0, Vec3(base + past, side, 0) + at_depth(set, 1e-3 * kSize), base)
          .bodies.force[0];
    };
    const Vec3 before = force(-1e-9 * kSize), after = force(1e-9 * kSize);
    worst = std::max(worst, (after - before).norm() / before.norm());
  }
  return {worst, 1e-6};
}

// A foot on a foot, passing sidewise: energy before and after a pass are the same, force falls to
// nothing with the overlap.
Measured foot_over_foot(const Setting& set) {
  double worst = 0;
  for (const double shift : {-1e-9, 1e-9}) {
    Scene s = scene_of(set, kModulus, 0, kSize);
    const dem::GrainShape g = grain(set.shape, kSize, 0);
    const int shape = s.shapes.add(g);
    const Quat down = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, -1)),
               up = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 0, 1));
    const Foot f = foot(set.shape);
    const double depth = 1e-4 * kSize, apart = 2 * (f.radius + f.below) - depth;
    dem::add_grain(s.bodies, s.shapes, shape, 0, 2600, up * g.origin, up * g.turn, dem::kFree);
    dem::add_grain(s.bodies, s.shapes, shape, 0, 2600,
                   Vec3(shift * kSize, 0, apart) + down * g.origin, down * g.turn, dem::kFree);
    s.prepare();
    const double hertz = set.law == "linear"
                             ? force_of(set, depth)
                             : 4. / 3 * kModulus * std::sqrt(f.radius / 2) * std::pow(depth, 1.5);
    worst = std::max(worst, std::abs(s.bodies.force[1].z() / hertz - 1));
  }
  return {worst, 1e-6};
}

Measured turned_pair(const Setting& set) {
  Scene s = standing(set, 10, at_depth(set, 1e-2 * kSize));
  return {change_of_a_turned_pair(s, 1e-3 * kSize), 1e-10};
}

// Everything 1 km away, and the seam of a period between grain and floor's middle.
Measured moved(const Setting& set) {
  const double depth = 1e-3 * kSize;
  Scene here = standing(set, .5, at_depth(set, depth)), there = here;
  const Vec3 far(1000, -1000, 1000);
  for (Vec3& x : there.bodies.x) x += far;
  there.prepare();
  return {(there.bodies.force[0] - here.bodies.force[0]).norm() / here.bodies.force[0].norm(),
          1e-7};  // 1e-13 of a kilometre over the depth
}

Measured base_size(const Setting& set) {
  const double depth = 1e-4 * kSize,
               small = standing(set, 0, at_depth(set, depth), 1).bodies.force[0].z(),
               large = standing(set, 0, at_depth(set, depth), 100).bodies.force[0].z();
  return {std::abs(large / small - 1), 1e-8};
}

}  // namespace

const std::vector<Case>& round_cases() {
  const auto over = Over::round_shapes;
  static const std::vector<Case> cases{
      {"round: force of the law, overlap 1e-9 to 1e-2", "the law's force", "relative difference",
       "none", over, false, false, force_is_the_laws},
      {"round: at rest", "the floor carries the weight", "relative difference", "local, 0.5", over,
       true, false, at_rest},
      {"round: nearly touching, coming and going", "touches once, leaves once", "changes", "none",
       over, true, false, toggles},
      {"round: closed path on an edge and a corner", "no work", "share of the stored energy",
       "none", over, false, false, closed_path},
      {"round: across an edge and a corner", "no jump of the force", "relative difference", "none",
       over, false, false, across_an_edge},
      {"round: foot over foot, 1e-9 aside", "the law's force", "relative difference", "none", over,
       false, false, foot_over_foot},
      {"round: stuck pair turned by 360 degrees", "the force turns along",
       "share of the sideways force", "none", over, false, false, turned_pair},
      {"round: a kilometre from the origin", "the same force", "relative difference", "none", over,
       false, false, moved},
      {"round: small grain on a base of 2 or 200 m", "penetration does not depend on the base",
       "relative difference", "none", over, false, false, base_size}};
  return cases;
}

}  // namespace trackbed::hard
