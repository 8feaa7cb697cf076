#include "dem/packing/friction_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace trackbed::dem {
namespace {

double void_ratio(double n) { return n / (1 - n); }

std::string text(const char* format, double a, double b, double c = 0, double d = 0, double e = 0) {
  char line[240];
  std::snprintf(line, sizeof line, format, a, b, c, d, e);
  return line;
}

}  // namespace

double porosity_at(double density, double loosest, double densest) {
  const double most = void_ratio(loosest), least = void_ratio(densest);
  const double e = most - density * (most - least);
  return e / (1 + e);
}

double relative_density_at(double porosity, double loosest, double densest) {
  const double most = void_ratio(loosest), least = void_ratio(densest);
  return (most - void_ratio(porosity)) / (most - least);
}

void validate(const FrictionPathSettings& s) {
  if (s.friction.size() < 2) throw InputError("at least two frictions make a path");
  for (std::size_t k = 1; k < s.friction.size(); ++k)
    if (!(s.friction[k] < s.friction[k - 1]) || s.friction[k] < 0)
      throw InputError(text("%g follows %g; friction must fall from step to step", s.friction[k],
                            s.friction[k - 1]));
  if ((s.porosity >= 0) == (s.relative_density >= 0))
    throw InputError("either a porosity or a relative density must be wanted");
  if (s.relative_density > 1 || s.porosity >= 1)
    throw InputError("the wanted porosity or relative density is 1 at most");
}

FrictionStep next_step(const FrictionPathSettings& s, const std::vector<FrictionPoint>& points) {
  const int made = static_cast<int>(points.size()), all = static_cast<int>(s.friction.size());
  int rungs = 1;
  while (rungs < std::min(made, all) && points[rungs].stop_at == 0 &&
         points[rungs].friction == s.friction[rungs])
    ++rungs;
  const FrictionStep down{false, rungs - 1, rungs < all ? s.friction[rungs] : 0, 0};

  double wanted = s.porosity;
  if (wanted < 0) {
    if (rungs < all && s.relative_density > 0) return down;
    const double densest = rungs == all ? points[all - 1].porosity : points[0].porosity;
    wanted = porosity_at(s.relative_density, points[0].porosity, densest);
  }
  for (int k = 0; k < made; ++k)
    if (std::abs(points[k].porosity - wanted) <= s.tolerance) return {true, k, 0, 0};

  int start = 0;  // last rung that is looser than wanted, the next one is denser
  while (start + 1 < rungs &&
         !(points[start].porosity > wanted && points[start + 1].porosity < wanted))
    ++start;
  if (start + 1 == rungs) {
    // On down, to the end even when the deposit is too dense already: the whole range is told.
    if (rungs < all) return down;
    double loosest = 0, densest = 1;
    for (const FrictionPoint& p : points)
      loosest = std::max(loosest, p.porosity), densest = std::min(densest, p.porosity);
    throw InputError(
        text("a porosity of %.4f cannot be reached; these grains reach %.4f (friction "
             "%g) to %.4f (friction %g)",
             wanted, densest, s.friction.back(), loosest, s.friction.front()));
  }

  FrictionPoint loose = points[start], dense = points[start + 1];
  int trials = 0, stops = 0;
  double stop_at = wanted;
  for (int k = rungs; k < made; ++k) {
    const FrictionPoint& p = points[k];
    if (p.stop_at > 0) {
      ++stops;
      stop_at = p.stop_at + wanted - p.porosity;
      continue;
    }
    ++trials;
    if (p.porosity > wanted && p.friction < loose.friction) loose = p;
    if (p.porosity < wanted && p.friction > dense.friction) dense = p;
  }
  const double width = loose.friction - dense.friction;
  if (trials < s.most_trials && width > 1e-4) {
    const double share = (loose.porosity - wanted) / (loose.porosity - dense.porosity);
    return {false, start, loose.friction - width * std::clamp(share, 0.1, 0.9), 0};
  }
  if (stops < s.most_trials) return {false, start, dense.friction, stop_at};
  throw InputError(
      text("the bed does not stop at a porosity of %.4f: it jumps from %.4f at "
           "friction %.4g to %.4f at %.4g; a larger tolerance or more grains are "
           "needed",
           wanted, loose.porosity, loose.friction, dense.porosity, dense.friction));
}

}  // namespace trackbed::dem
