#include "dem/motion/monitor.h"

#include <algorithm>
#include <sstream>

namespace trackbed::dem {
namespace {

constexpr double kInside = 0.5;       // of the smaller body's volume
constexpr double kLookInside = 0.02;  // depth over size from which that is looked at
constexpr double kLargestMove = 0.1;  // of a grain's size in a step

std::string place(const Vec3& x) {
  std::ostringstream s;
  s << "(" << x.x() << ", " << x.y() << ", " << x.z() << ") m";
  return s.str();
}

std::string name(const Bodies& b, int i) {
  return (i < b.grains ? "grain " : "rigid body ") + std::to_string(i);
}

// The touching pair of a body with the largest force; -1: it touches nothing.
int strongest_contact(const Pairs& pairs, int i) {
  int worst = -1;
  double most = -1;
  for (int k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
    const int p = pairs.incident[k] >= 0 ? pairs.incident[k] : ~pairs.incident[k];
    const double f = pairs.force[p].norm();
    if (pairs.touching[p] && !(f <= most)) worst = p, most = f;
  }
  return worst;
}

bool finite(const Bodies& b, int i) {
  return b.x[i].allFinite() && b.v[i].allFinite() && b.q[i].coeffs().allFinite() &&
         b.omega[i].allFinite() && b.force[i].allFinite() && b.torque[i].allFinite();
}

double volume(const Bodies& b, const ShapeTable& shapes, int i) {
  return shapes.shape(b.shape[i]).volume;
}

double size(const Bodies& b, const ShapeTable& shapes, int i) {
  return std::cbrt(volume(b, shapes, i));
}

double smaller(const Bodies& b, const ShapeTable& shapes, const Pairs& pairs, int p) {
  return std::min(volume(b, shapes, pairs.a[p]), volume(b, shapes, pairs.b[p]));
}

double depth_share(const Bodies& b, const ShapeTable& shapes, const Pairs& pairs, int p) {
  return pairs.depth[p] / std::cbrt(smaller(b, shapes, pairs, p));
}

// Of two plain polyhedra, over the smaller body's volume; 0 of round ones, whose depth goes on
// growing as one sinks into the other.
double volume_share(const Bodies& b, const ShapeTable& shapes, const StepContext& c,
                    const Pairs& pairs, int p) {
  if (p >= pairs.end(PairKind::polyhedra)) return 0;
  const int i = pairs.a[p], j = pairs.b[p];
  const ConvexView& va = shapes.part(b.shape[i], pairs.part_a[p]).core;
  const ConvexView& vb = shapes.part(b.shape[j], pairs.part_b[p]).core;
  const Pose pa{b.R[i], b.x[i]};
  const Pose pb{b.R[j], b.x[j] + nearest_image(b.x[i], b.x[j], c.period)};
  OverlapWorkspace work;
  OverlapMoments moments;
  overlap(va, pa, vb, pb, contact_frame(va, pa, vb, pb, pairs.axis[p]), work, moments);
  return moments.volume / smaller(b, shapes, pairs, p);
}

// Collects what every complaint needs.
struct Check {
  const Bodies& b;
  const ShapeTable& shapes;
  const Pairs& pairs;
  const StepContext& c;
  std::string start;

  [[noreturn]] void stop(const std::ostringstream& text, int body, int other) const {
    throw StateFault(start + text.str(), body, other);
  }
  // Of a body that is at fault alone: with what it touches hardest.
  [[noreturn]] void stop(int i, const std::string& what, const std::string& cause) const {
    std::ostringstream s;
    s << name(b, i) << what << "; ";
    const int p = strongest_contact(pairs, i);
    if (p < 0) {
      s << "it touches nothing";
    } else {
      s << "its strongest contact is " << name(b, pairs.a[p]) << " with " << name(b, pairs.b[p])
        << ", " << pairs.force[p].norm() << " N, depth " << pairs.depth[p] << " m";
    }
    s << ". " << cause;
    stop(s, i, p < 0 ? -1 : pairs.a[p] + pairs.b[p] - i);
  }
  std::string step_text() const {
    std::ostringstream s;
    s << "the time step " << c.dt << " s is too large";
    return s.str();
  }

  void body(int i, const StateLimits& limits) const {
    if (!finite(b, i))
      stop(
          i, ": its motion or force is not a finite number",
          "Likely cause: " + step_text() +
              ", or bodies started far inside each other. Remedy: a smaller share of the stability "
              "limit, or grains apart at the start.");
    if (i >= b.grains) return;
    if ((b.x[i] - limits.region.low).minCoeff() < 0 ||
        (limits.region.high - b.x[i]).minCoeff() < 0) {
      std::ostringstream s;
      s << " has left the scene at " << place(b.x[i]) << " with " << b.v[i].norm() << " m/s";
      stop(i, s.str(),
           "Likely cause: a wall is missing or too thin, or " + step_text() +
               ". Remedy: a larger container, or a smaller share of the stability limit.");
    }
    const double speed = b.v[i].norm();
    const double allowed = limits.speed.speed + std::sqrt(2 * limits.speed.energy / b.mass[i]);
    if (speed > allowed) {
      std::ostringstream s;
      s << " flies off at " << place(b.x[i]) << " with " << speed << " m/s (at most " << allowed
        << " m/s can be explained)";
      stop(i, s.str(),
           "Likely cause: " + step_text() +
               " and made energy, or the grain started inside another. Remedy: a smaller share of "
               "the stability limit, more damping, or grains apart at the start.");
    }
    const double move = speed * c.dt / size(b, shapes, i);
    if (move > kLargestMove) {
      std::ostringstream s;
      s << " goes " << 100 * move << " % of its size in a step, with " << speed << " m/s";
      stop(i, s.str(),
           "Likely cause: " + step_text() +
               " for this speed; contacts would be missed. Remedy: a smaller one.");
    }
  }

  void overlaps(double deepest) const {
    int worst = -1;
    double most = 1, depth = 0, inside = 0, within = 0;
    for (int p = 0; p < pairs.size(); ++p) {
      const double deep = depth_share(b, shapes, pairs, p);
      // Pairs of parts of the same bodies follow one another.
      if (p == 0 || pairs.a[p] != pairs.a[p - 1] || pairs.b[p] != pairs.b[p - 1]) within = 0;
      if (deep > kLookInside) within += volume_share(b, shapes, c, pairs, p);
      const double beyond = std::max(deep / deepest, within / kInside);
      if (beyond > most) worst = p, most = beyond, depth = deep, inside = within;
    }
    if (worst < 0) return;
    std::ostringstream s;
    s << name(b, pairs.a[worst]) << " and " << name(b, pairs.b[worst]) << " overlap by "
      << pairs.depth[worst] << " m, " << 100 * depth << " % of the smaller one's size (allowed "
      << 100 * deepest << " %)";
    if (inside > kInside)
      s << "; " << 100 * inside << " % of its volume lies inside the other, where contact forces "
        << "vanish";
    s << ". Likely cause: the contact modulus is too soft for the load or speed, " << step_text()
      << ", or they started inside each other. Remedy: a larger contact modulus, a smaller share "
      << "of the stability limit, or grains apart at the start.";
    stop(s, pairs.a[worst], pairs.b[worst]);
  }
};

}  // namespace

Deepest deepest_overlap(const Bodies& b, const ShapeTable& shapes, const Pairs& pairs) {
  Deepest d;
  for (int p = 0; p < pairs.size(); ++p) {
    if (!pairs.touching[p]) continue;
    const double share = depth_share(b, shapes, pairs, p);
    if (share > d.share) d = {share, p};
  }
  return d;
}

void check_state(const Bodies& b, const ShapeTable& shapes, const Pairs& pairs,
                 const StepContext& c, long step, const StateLimits& limits,
                 const std::string& when) {
  const std::string start =
      "step " + std::to_string(step) + (when.empty() ? "" : " (" + when + ")") + ": ";
  const Check check{b, shapes, pairs, c, start};
  // An overlap that is too deep is the cause of what flies off.
  for (int i = 0; i < b.size(); ++i)
    if (!finite(b, i)) check.body(i, {});
  check.overlaps(limits.overlap);
  for (int i = 0; i < b.size(); ++i) check.body(i, limits);
}

}  // namespace trackbed::dem
