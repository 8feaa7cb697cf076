#include "dem/contact/restitution.h"

#include <cmath>

#include "base/error.h"

namespace trackbed::dem {
namespace {

struct Impact {
  bool hertz;
  double alpha;
  double force(double x, double v) const {
    x = std::max(x, 0.0);
    if (!hertz) return x + alpha * v;
    const double root = std::sqrt(x);
    return x * root + alpha * std::sqrt(root) * v;
  }
};

// Whether a law's force goes with overlap^(3/2), linearly otherwise.
bool is_hertz(const std::string& law) {
  if (law == "hertz_mindlin" || law == "hertz_flat") return true;
  if (law == "linear") return false;
  throw InputError("round law '" + law + "': its restitution is not known here");
}

}  // namespace

double restitution(bool hertz, double alpha) {
  const Impact impact{hertz, alpha};
  // Runge-Kutta of order 4 in s with t = s^2, in which the start is smooth: x^(1/4) ~ s^(1/2).
  const double h = 2e-3;
  double x = 0, v = 1, force = 0;
  for (int k = 0; k < 100000; ++k) {
    const double s = k * h, t = s * s, dt = (s + h) * (s + h) - t;
    if (!hertz && k == 0) force = alpha;
    const double was = force, v_old = v;
    const auto slope = [&](double at, double xx, double vv, double& dx, double& dv) {
      dx = 2 * at * vv, dv = -2 * at * std::max(0.0, impact.force(xx, vv));
    };
    double x1, v1, x2, v2, x3, v3, x4, v4;
    slope(s, x, v, x1, v1);
    slope(s + h / 2, x + h / 2 * x1, v + h / 2 * v1, x2, v2);
    slope(s + h / 2, x + h / 2 * x2, v + h / 2 * v2, x3, v3);
    slope(s + h, x + h * x3, v + h * v3, x4, v4);
    x += h / 6 * (x1 + 2 * x2 + 2 * x3 + x4);
    v += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    force = impact.force(x, v);
    // The force ends within this step: half of it times the share of the step until then is left.
    if (v < 0 && force <= 0) return -(v_old - 0.5 * was * dt * was / (was - force));
    if (v < 0 && x <= 0) return -v;
    // Overdamped: it creeps back; what speed it has at the end is that of x = 0.
    if (std::abs(v) < 1e-12 && x < 1e-9) break;
  }
  return std::max(0.0, -v);
}

double tsuji_damping(double e) {
  const double l = std::log(e);
  return -std::sqrt(5.0) * l / std::sqrt(l * l + M_PI * M_PI);
}

double damping_for_restitution(const std::string& law, double e) {
  if (!(e >= 0.01 && e <= 1))
    throw InputError("restitution " + std::to_string(e) + " is out of range: 0.01 to 1");
  if (e == 1) return 0;
  if (law == "sun2015") return tsuji_damping(e);
  const bool hertz = is_hertz(law);
  double low = 0, high = 1;
  while (restitution(hertz, high) > e) high *= 2;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (restitution(hertz, middle) > e ? low : high) = middle;
  }
  return (low + high) / 2;
}

double restitution_for_damping(const std::string& law, double alpha) {
  if (alpha == 0) return 1;
  if (law != "sun2015") return restitution(is_hertz(law), alpha);
  const double share = alpha / std::sqrt(5.0);
  return std::exp(-M_PI * share / std::sqrt(1 - share * share));
}

}  // namespace trackbed::dem
