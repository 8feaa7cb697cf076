#include "apps/trackbed/grain_estimate.h"

#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/layout.h"

namespace trackbed::apps {

std::vector<GradationClass> gradation_classes(const Scene& scene) {
  const dem::SieveCurve curve = gradation_curve(scene);
  const double total = make_layout(scene).bed_mass;
  std::vector<GradationClass> classes;
  for (const auto& k : dem::sieve_classes(curve)) {
    if (k.percent <= 0) continue;
    const double d = 0.5 * (k.low + k.high), mass = 0.01 * k.percent * total;
    classes.push_back({k.low, k.high, 0.01 * k.percent, mass,
                       mass / (scene.grains.density * 0.6 * d * d * d),
                       k.low >= curve.sieve.back()});
  }
  return classes;
}

}  // namespace trackbed::apps
