// A slender cantilever of 2.6 x 0.28 x 0.2 m, 40 GPa, without Poisson's ratio, under an end load:
// Timoshenko's beam is the exact answer of its mean deflection.
#pragma once
#include <cmath>

#include "fem/elastic_body.h"

namespace trackbed::fem::known {

struct Bending {
  double error;  ///< of the tip's deflection, relative
  int unknowns;
};

/// Downward deflection of the free end [m] of a body along x, held at x_min, under 1000 N there.
inline double tip_deflection(ElasticBodyParameters p, int* unknowns = nullptr) {
  p.supports = {{"x_min", Support::fixed}};
  p.loads = {{"end", "x_max"}};
  ElasticBody b(p);
  b.set_load(0, 1000);
  b.solve_static();
  if (unknowns) *unknowns = b.unknowns();
  return -b.load_displacement(0)[2];
}

/// 13 n cells along the length, n over height and width.
inline Bending bent_cantilever(int order, Element element, int n) {
  const double exact =
      1000 * (std::pow(2.6, 3) / (3 * 40e9 * .28 * .008 / 12) + 2.6 / (20e9 * .28 * .2 * 5 / 6));
  ElasticBodyParameters p;
  p.mesh.lengths = {2.6, .28, .2};
  p.mesh.elements = {13 * n, n, n};
  p.materials = {{"concrete", 40e9, 0., 2500}};
  p.order = order;
  p.element = element;
  Bending result;
  result.error = std::abs(tip_deflection(p, &result.unknowns) / exact - 1);
  return result;
}

}  // namespace trackbed::fem::known
