// A pulse down a rod that ends in dashpots: how much of its energy comes back.
#pragma once
#include <cmath>

#include "fem/elastic_body.h"

namespace trackbed::fem::known {

struct Reflection {
  double energy;     ///< that comes back, over the pulse's; exactly ((1−r)/(1+r))²
  double numerical;  ///< energy not accounted for, over the pulse's
};

/// A rod of 4 m and `cells` cells, a pulse of 1 m, dashpots of r ρc at its far end.
inline Reflection reflection(double r, int cells) {
  const double young = 1e8, rho = 2000, c = std::sqrt(young / rho);
  ElasticBodyParameters p;
  p.mesh.lengths = {0.05, 0.05, 4};
  p.mesh.elements = {1, 1, cells};
  p.materials = {{"rod", young, 0., rho}};
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) p.supports[side] = Support::roller;
  p.beds = {{"bottom", 0, 0, r * rho * c, 0}};
  p.loads = {{"top", "top"}};
  p.newmark = true;
  ElasticBody b(p);
  const double dt = 0.4 * (4. / cells) / c, pulse = 1. / c;
  b.set_step(dt);
  double in = 0;
  for (int n = 1; n * dt < 6 / c; ++n) {  // after 6 m it is on its way back
    const double t = n * dt;
    b.set_load(0, t < pulse ? 1000 * std::pow(std::sin(M_PI * t / pulse), 2) : 0.);
    b.advance({});
    if (n == std::lround(2 / (c * dt))) in = b.energy().kinetic + b.energy().strain;
  }
  const auto e = b.energy();
  return {(e.kinetic + e.strain) / in, e.numerical / in};
}

}  // namespace trackbed::fem::known
