// The surface of a heap as a curve: height against distance from vertical cuts, and its slope.
#pragma once
#include <vector>

#include "apps/trackbed/grain_tests/strength.h"
#include "dem/packing/section.h"

namespace trackbed::apps {

struct ProfileSlice {
  double distance = 0;       ///< of its middle [m]
  double height = 0;         ///< mean of the cuts [m]
  std::vector<double> cuts;  ///< mean height of each cut's upper outline [m]
  bool fitted = false;       ///< lies on the slope
};

/// Slices of equal width from `low` to `high` along x. The height of a cut (planes across y) at an
/// x is that of the highest outline there above `floor`, 0 where there is none; a slice's is the
/// mean over `points` of its x.
std::vector<ProfileSlice> heap_profile(const std::vector<dem::PlacedGrain>&,
                                       const dem::Vec3& period,
                                       const std::vector<dem::CuttingPlane>&, double low,
                                       double high, double floor, int slices, int points = 10);

/// Angle [rad] of the straight line through the slope: the slices that follow the last one above
/// 80 % of the largest height, down to the first one below 20 %; these are marked. Crest and foot,
/// which are round, are so left out. Its standard error is that of the mean of the cuts' own
/// angles, over the same slices: cuts a grain apart are independent, neighbouring slices are not.
/// Unknown where there are fewer than three slices; no error from a single cut.
Estimate slope_angle(std::vector<ProfileSlice>&);

}  // namespace trackbed::apps
