#include "dem/motion/monitor.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"

namespace trackbed::dem {
namespace {

std::string place(const Vec3& x) {
  std::ostringstream s;
  s << "(" << x.x() << ", " << x.y() << ", " << x.z() << ") m";
  return s.str();
}

std::string name(const Bodies& b, int i) {
  return (i < b.grains ? "grain " : "rigid body ") + std::to_string(i);
}

/// The touching pair of a body with the largest force, in words.
std::string strongest_contact(const Bodies& b, const Pairs& pairs, int i) {
  int worst = -1;
  double most = -1;
  for (int k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
    const int p = pairs.incident[k] >= 0 ? pairs.incident[k] : ~pairs.incident[k];
    const double f = pairs.force[p].norm();
    if (pairs.touching[p] && !(f <= most)) worst = p, most = f;
  }
  if (worst < 0) return "it touches nothing";
  std::ostringstream s;
  s << "its strongest contact is " << name(b, pairs.a[worst]) << " with " << name(b, pairs.b[worst])
    << ", " << most << " N, depth " << pairs.depth[worst] << " m";
  return s.str();
}

bool finite(const Bodies& b, int i) {
  return b.x[i].allFinite() && b.v[i].allFinite() && b.q[i].coeffs().allFinite() &&
         b.omega[i].allFinite() && b.force[i].allFinite() && b.torque[i].allFinite();
}

double size(const Bodies& b, const ShapeTable& shapes, int i) {
  return std::cbrt(shapes.shape(b.shape[i]).volume);
}

}  // namespace

Deepest deepest_overlap(const Bodies& b, const ShapeTable& shapes, const Pairs& pairs) {
  Deepest d;
  for (int p = 0; p < pairs.size(); ++p) {
    if (!pairs.touching[p]) continue;
    const double share =
        pairs.depth[p] / std::min(size(b, shapes, pairs.a[p]), size(b, shapes, pairs.b[p]));
    if (share > d.share) d = {share, p};
  }
  return d;
}

void check_state(const Bodies& b, const ShapeTable& shapes, const Pairs& pairs,
                 const StepContext& c, long step, const Region& region, double deepest) {
  std::ostringstream s;
  s << "step " << step << ": ";
  for (int i = 0; i < b.size(); ++i) {
    if (!finite(b, i)) {
      s << name(b, i) << ": its motion or force is not a finite number; "
        << strongest_contact(b, pairs, i) << ". Likely cause: the time step " << c.dt
        << " s is too large, or bodies started far inside each other.";
      throw RunError(s.str());
    }
    if (i < b.grains &&
        ((b.x[i] - region.low).minCoeff() < 0 || (region.high - b.x[i]).minCoeff() < 0)) {
      s << name(b, i) << " has left the scene at " << place(b.x[i]) << " with " << b.v[i].norm()
        << " m/s; " << strongest_contact(b, pairs, i)
        << ". Likely cause: a wall is missing or too thin, or the time step " << c.dt
        << " s is too large.";
      throw RunError(s.str());
    }
  }
  const Deepest d = deepest_overlap(b, shapes, pairs);
  if (d.share > deepest) {
    const int p = d.pair;
    s << name(b, pairs.a[p]) << " and " << name(b, pairs.b[p]) << " overlap by " << pairs.depth[p]
      << " m, " << 100 * d.share << " % of the smaller one's size (allowed " << 100 * deepest
      << " %). Likely cause: the contact modulus is too soft for the load or speed,"
      << " or the time step " << c.dt << " s is too large.";
    throw RunError(s.str());
  }
}

}  // namespace trackbed::dem
