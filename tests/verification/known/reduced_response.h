// A sleeper and a block of soil, and how far their reduced bodies follow the full ones.
#pragma once
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "fem/reduction.h"

namespace trackbed::fem::known {

inline ElasticBodyParameters sleeper() {
  ElasticBodyParameters p;
  p.name = "Sleeper";
  p.mesh.corner = {-1.3, -0.14, 0};
  p.mesh.lengths = {2.6, 0.28, 0.2};
  p.mesh.elements = {26, 2, 2};
  p.materials = {{"concrete", 40e9, 0.2, 360 / (2.6 * 0.28 * 0.2)}};
  p.loads = {{"left", "top", true, -0.75, 0, 0.15, 0.15},
             {"right", "top", true, 0.75, 0, 0.15, 0.15}};
  p.contact = {"bottom", "top", "x_min", "x_max"};
  return p;
}

inline ElasticBodyParameters soil() {
  ElasticBodyParameters p;
  p.name = "Subgrade";
  p.mesh.corner = {0, 0, -0.6};
  p.mesh.lengths = {0.6, 0.3, 0.6};
  p.mesh.elements = {6, 3, 6};
  p.materials = {{"soil", 60e6, 0.35, 1900}};
  p.supports["bottom"] = Support::fixed;
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) p.supports[side] = Support::roller;
  p.contact = {"top"};
  return p;
}

// Forces on some nodes that come smoothly, as those of grains under a load do.
inline std::vector<Vec> forces(std::size_t nodes, double t) {
  std::vector<Vec> f(nodes, Vec{});
  for (std::size_t i = 0; i < nodes; i += 5)
    f[i] = {0, 20 * std::pow(std::sin(200 * t), 3),
            -100 * std::pow(std::sin(300 * t), 2) * (1 + 0.5 * std::sin(1. * i))};
  return f;
}

struct Deviation {
  double error;            ///< largest difference of the surface's place over a run, over the
                           ///< largest displacement
  int modes;               ///< of the basis, residual vectors included
  double full_step, step;  ///< processor time of a step of each [s]
};

inline Deviation deviation(const ElasticBodyParameters& p, Reduction reduction, int modes) {
  auto full_parameters = p;
  full_parameters.newmark = true;
  ElasticBody full(full_parameters);
  const auto reduced = reduced_body(p, reduction, modes);
  const double dt = 1e-5;
  const int steps = 1000;
  full.set_step(dt);
  reduced->set_step(dt);
  std::vector<Vec> u, v, w;
  double worst = 0, largest = 0;
  std::clock_t full_time = 0, reduced_time = 0;
  for (int n = 1; n <= steps; ++n) {
    for (int l = 0; l < full.loads(); ++l) {
      full.set_load(l, 1000 * std::sin(100. * n * dt));
      reduced->set_load(l, 1000 * std::sin(100. * n * dt));
    }
    const auto f = forces(full.surface().nodes.size(), n * dt);
    const std::clock_t begun = std::clock();
    full.advance(f);
    const std::clock_t half = std::clock();
    reduced->advance(f);
    full_time += half - begun, reduced_time += std::clock() - half;
    if (n % 50) continue;
    full.motion(u, v);
    reduced->motion(w, v);
    for (std::size_t i = 0; i < u.size(); ++i)
      for (int d = 0; d < 3; ++d) {
        worst = std::max(worst, std::abs(u[i][d] - w[i][d]));
        largest = std::max(largest, std::abs(u[i][d]));
      }
  }
  const double tick = 1. / CLOCKS_PER_SEC / steps;
  return {worst / largest, reduced->modes(), full_time * tick, reduced_time * tick};
}

}  // namespace trackbed::fem::known
