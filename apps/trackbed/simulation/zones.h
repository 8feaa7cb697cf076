// Zones of a bed: fine, angular grains under the sleeper where they matter, coarser or simpler
// ones outside, a ring in between where both are mixed (the layered modelling of Chen, Wu, Jin
// 2022, for ballast). Zones are columns in plan, so that gravity keeps them apart.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/simulation/stage.h"
#include "dem/packing/place.h"

namespace trackbed::apps {

/// The scene with the coarse grains' library and gradation for its own.
Scene coarse_scene(const Scene&);

struct Zone {
  std::string name;  ///< "fine", "transition", "coarse"
  double area = 0;   ///< in plan, the sleeper's footprint left out where grains lie beside it [m2]
  double fine = 0;   ///< share of fine grains in its mass
};

/// From the inside out, three of them.
std::vector<Zone> make_zones(const Scene&, const Layout&, bool beside);

/// The inner zones' rectangles, as PlacementSpace takes them.
std::vector<dem::PlacementSpace::Block> zone_rectangles(const Scene&, const Layout&);

/// Index of the zone in which a point lies in plan.
int zone_at(const std::vector<dem::PlacementSpace::Block>& rectangles, const dem::Vec3&);

/// Grains to be poured; the first `fine` of them are the scene's own, the others coarse ones.
struct GrainBatch {
  std::vector<dem::GrainShape> grains;
  int fine = 0;
  std::vector<int> zone;  ///< of each; empty = anywhere
};

/// Grains of a total mass [kg], spread over the zones by their area, or the scene's own everywhere
/// where it has no zones.
GrainBatch draw_batch(Run&, double mass, int stream, bool beside);

/// What zones cost and save, before any grain is made.
struct ZoneEstimate {
  std::string name;
  double mass = 0;      ///< of grains poured [kg]
  double grains = 0;    ///< expected number
  double all_fine = 0;  ///< number if they were all fine
};
std::vector<ZoneEstimate> estimate_zones(const Scene&);

/// zones.csv of a run: counts by zone as they ended, and how many grains an all-fine bed of that
/// mass would have.
void write_zones(const Run&, const std::string& file);

}  // namespace trackbed::apps
