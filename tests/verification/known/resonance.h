// One mass on a spring with a dashpot, driven at its own frequency.
#pragma once
#include <algorithm>
#include <cmath>

#include "fem/time_integration.h"

namespace trackbed::fem::known {

/// Steady amplitude over F/(2 xi k), m = k = F = 1, xi = .05, generalised-alpha of rho_inf .9.
inline double amplitude_at_resonance() {
  const double xi = 0.05, dt = 0.01;
  Matrices m;
  m.pattern = {{0, 1}, {0}};
  m.stiffness = {1}, m.mass = {1}, m.damping = {2 * xi};
  Stepper stepper(m, generalised_alpha(0.9));
  stepper.set_step(dt);
  Motion s{{0}, {0}, {0}, {0}};
  double largest = 0;
  for (int n = 1; n < 40000; ++n) {
    stepper.advance(s, {std::sin(n * dt)});
    if (n > 30000) largest = std::max(largest, std::abs(s.u[0]));
  }
  return largest * 2 * xi;
}

}  // namespace trackbed::fem::known
