// What a test of grains keeps from step to step; part of every checkpoint.
#pragma once
#include <vector>

#include "dem/types.h"

namespace trackbed::apps {

struct GrainTestState {
  int specimen = 0;                   ///< which of Test/Stresses
  dem::Vec3 low = dem::Vec3::Zero();  ///< inner space when the walls were put in [m]
  dem::Vec3 high = dem::Vec3::Zero();
  std::vector<dem::Vec3> placed;          ///< centres of the walls then, in their order [m]
  dem::Vec3 lengths = dem::Vec3::Zero();  ///< of the inner space at the start of shearing [m]
  double plane = 0;                       ///< height of the shear plane [m]
  std::vector<double> drift;              ///< of each servo [m/s]
  std::vector<double> sum;                ///< of the row under way, over its steps
  int steps = 0;                          ///< in that sum
  int rows_done = 0;                      ///< of this specimen
  std::vector<double> rows;               ///< of all specimens, one after the other
  double solid = 0;                       ///< volume of all grains [m3]
  double size = 0;                        ///< mean grain size by mass [m]
};

}  // namespace trackbed::apps
