// How many grains a scene will have, class by class, before any is made.
#pragma once
#include <vector>

#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// One sieve class that holds mass.
struct GradationClass {
  double lower, upper;  ///< sieve openings [m]
  double share;         ///< of the total mass
  double mass;          ///< [kg]
  double grains;        ///< expected number, with V = 0.6 d^3 per grain, d the mean opening
  bool open;            ///< beyond the last sieve: `upper` is Gradation/Top sieve
};

/// The classes of the bed under the sleeper that hold mass, from small to large.
std::vector<GradationClass> gradation_classes(const Scene&);

}  // namespace trackbed::apps
