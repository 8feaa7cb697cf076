#include "coupling/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed::coupling {

dem::TimeStepLimit measured_limit(const World& w, int threads) {
  dem::TimeStepLimit limit = dem::measured_limit(w.bodies, w.pairs, threads);
  const dem::Bodies& b = w.bodies;
  double surface = 0;  // omega^2
  int body = -1;
  for (const Surface& s : w.surfaces) {
    const dem::PatchContacts& k = s.contacts;
    std::vector<double> node(s.patch.carried, 0.0);
    for (int i = 0; i < k.size(); ++i) {
      if (!k.touching[i]) continue;
      const int g = k.grain[i];
      const double arm2 = k.arm[i].squaredNorm();
      const double omega2 = 2 * k.stiffness[i] * (1 / b.mass[g] + arm2 / b.inertia[g].minCoeff());
      if (omega2 > surface) surface = omega2, body = g;
      for (const auto& [n, force] : k.nodal[i])
        node[s.patch.master[n]] +=
            k.stiffness[i] * force.norm() / std::max(k.force[i].norm(), 1e-300);
    }
    double stiffest = 0;
    for (const double sum : node) stiffest = std::max(stiffest, sum);
    const double omega2 = 2 * stiffest / s.structure->least_surface_mass();
    if (omega2 > surface) surface = omega2, body = -1;
  }
  if (surface == 0) return limit;
  if (std::sqrt(surface) > limit.omega) limit.body = body;
  limit.omega = std::sqrt(limit.omega * limit.omega + surface);
  limit.dt = 2 / limit.omega;
  return limit;
}

}  // namespace trackbed::coupling
