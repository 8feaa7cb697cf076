#include "dem/motion/adaptive_damping.h"

#include <cmath>

#include "dem/motion/energy.h"

namespace trackbed::dem {

double damp(AdaptiveDamping& d, Bodies& b, const StepContext& c) {
  const double before = kinetic_energy(b), keep = std::exp(-d.alpha * c.dt);
#pragma omp parallel for schedule(static) num_threads(c.threads) if (c.threads > 1)
  for (int i = 0; i < b.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      if (b.freedom[i] >> k & 1) b.v[i][k] *= keep;
    if (b.freedom[i] >> 3) b.L[i] *= keep, b.omega[i] *= keep;
  }
  const double after = kinetic_energy(b), absorbed = before - after;
  if (d.kinetic >= 0) {
    const double change = std::abs(after - d.kinetic);
    d.alpha *= absorbed < 0.5 * change ? 1.1 : 0.99;
  }
  d.kinetic = after;
  return absorbed;
}

}  // namespace trackbed::dem
