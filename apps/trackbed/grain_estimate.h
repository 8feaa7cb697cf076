// How many grains a scene will have, class by class, before any is made.
#pragma once
#include <vector>

#include "apps/trackbed/scene.h"
#include "dem/grading/curve.h"

namespace trackbed::apps {

/// One sieve class that holds mass.
struct GradationClass {
  double lower, upper;  ///< sieve openings [m]
  double share;         ///< of the total mass
  double mass;          ///< [kg]
  double grains;        ///< expected number, with V = 0.6 d^3 per grain, d the mean opening
  bool open;            ///< beyond the last sieve: `upper` is Gradation/Top sieve
};

/// The scene's curve, by name or from its table, with the top sieve that the scene gives. A named
/// curve that ends at 100 % keeps its own ends.
dem::SieveCurve gradation_curve(const GradationScene&);

/// The classes that hold mass, from small to large.
std::vector<GradationClass> gradation_classes(const Scene&);

/// Volume of the bed's region: the ballast under the sleeper, without the fill beside it [m3].
double bed_volume(const ContainerScene&);

/// Mass of grains that are packed: bulk density times bed_volume (Shao 2017, Eq. 15) [kg].
double bed_mass(const Scene&);

/// Mass of ballast put beside the sleeper after packing, at the bulk density [kg].
double fill_mass(const Scene&);

}  // namespace trackbed::apps
