// Even pressure on a disc on a half-space (Love 1929): E 20 MPa, ν .35, 100 kPa on a radius of .3
// m.
#pragma once
#include <cmath>

#include "fem/elastic_body.h"

namespace trackbed::fem::known {

struct HalfSpace {
  double centre, mean;  ///< settlement [m]; exactly 2.632500e-3 and 2.234535e-3
  double stress;        ///< on the axis at a depth of one radius [Pa]; exactly 64.645e3
  int unknowns;
};

/// A quarter of a block of `size` radii in depth and to its sides, cells graded.
inline HalfSpace half_space_under_a_disc(double size) {
  const double a = 0.3, pressure = 1e5;
  std::vector<double> out(8, 0.05);
  for (double w = 0.07, sum = 0.4; sum < size * a; w *= 1.5) out.push_back(w), sum += w;
  ElasticBodyParameters p;
  p.mesh.widths = {out, out, {out.rbegin(), out.rend()}};
  p.mesh.corner[2] = 0;
  for (double w : out) p.mesh.corner[2] -= w;
  p.materials = {{"soil", 20e6, 0.35, 1900}};
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) p.supports[side] = Support::roller;
  p.supports["bottom"] = Support::fixed;
  p.contact = {"top"};
  ElasticBody b(p);
  const auto& s = b.surface();
  std::vector<Vec> f(s.nodes.size(), Vec{}), u, v;
  constexpr int n = 40;  // points a side of each quad, those inside the disc carry load
  double carried = 0;
  for (const auto& q : s.quads) {
    const Vec &low = s.nodes[q[0]], &high = s.nodes[q[2]];
    if (std::hypot(std::min(low[0], high[0]), std::min(low[1], high[1])) > a) continue;
    const double share = std::abs((high[0] - low[0]) * (high[1] - low[1])) / (n * n) * pressure;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = low[0] + (i + 0.5) / n * (high[0] - low[0]),
                     y = low[1] + (j + 0.5) / n * (high[1] - low[1]);
        if (std::hypot(x, y) > a) continue;
        carried += share;
        for (int node : q) {
          const double wx = 1 - std::abs(x - s.nodes[node][0]) / std::abs(high[0] - low[0]);
          const double wy = 1 - std::abs(y - s.nodes[node][1]) / std::abs(high[1] - low[1]);
          f[node][2] -= share * wx * wy;
        }
      }
  }
  b.solve_static(f);
  b.motion(u, v);
  double mean = 0, centre = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    mean += f[i][2] * u[i][2] / carried;
    if (std::hypot(s.nodes[i][0], s.nodes[i][1]) < 1e-9) centre = -u[i][2];
  }
  // On the axis at depth a, by Hooke's law from strains over two cells. Symmetry: u_y/y = u_x/x.
  const double h = 0.05, mu = 20e6 / 2.7, lambda = 2 * mu * 0.35 / 0.3;
  const double across = b.displacement_at({h, 0, -a})[0] / h;
  const double down =
      (b.displacement_at({0, 0, -a + h})[2] - b.displacement_at({0, 0, -a - h})[2]) / (2 * h);
  const double stress = -(lambda * (2 * across + down) + 2 * mu * down);
  return {centre, mean, stress, b.unknowns()};
}

}  // namespace trackbed::fem::known
