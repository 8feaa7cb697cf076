// Tests that tell what a packing's grains are worth: angle of repose, direct shear, triaxial. A
// test is a row of stages in place of the load cycles; its walls are held boxes with a prescribed
// motion, whose speed a servo finds where a stress is to be held (dem/surface/servo.h).
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// The stages of the scene's test; Test/Type is not none.
std::vector<Stage> grain_test_stages(const Scene&);

std::vector<Stage> repose_stages(const Scene&);
std::vector<Stage> shear_stages(const Scene&);
std::vector<Stage> triaxial_stages(const Scene&);

/// The inertial number that the scene's speed or strain rate makes at its least stress, with grains
/// of mean size `grain_size` [m]: strain rate x d sqrt(rho/p); of direct shear in a band of ten
/// grains. Above 1e-3 a test is not quasi-static. 0 for angle_of_repose.
double inertial_number(const Scene&, double grain_size);
inline constexpr double kQuasiStatic = 1e-3;

/// Writes the curve and strength.csv of what has been tested so far; returns what they say, a line
/// each.
std::vector<std::string> write_grain_test(const Run&, const std::string& folder);

}  // namespace trackbed::apps
