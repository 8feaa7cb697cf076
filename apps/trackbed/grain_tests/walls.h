// What the tests of grains have in common: walls put in anew for each specimen, servos on them,
// rows of a curve that are means over their steps.
#pragma once
#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// Before a specimen: the bed as it was packed (kept in FOLDER/test_bed.h5 when there are several)
/// without any wall, and the state of the test set to its start.
void begin_specimen(Run&);

/// Removes the kept bed.
void forget_test_bed(const Run&);

/// A held box [low, high] of a material. Walls follow each other in the order they are put in.
void add_test_wall(Run&, const dem::Vec3& low, const dem::Vec3& high, int material);

/// Bodies' indices of the test's walls.
inline int wall(const Run& run, int k) { return run.world.bodies.grains + k; }

/// How far a wall has gone since it was put in [m].
inline dem::Vec3 wall_travel(const Run& run, int k) {
  return run.world.bodies.x[wall(run, k)] - run.test.placed[k];
}

/// Stops all walls.
void hold_walls(Run&);

/// A wall of servo `servo` moves along `inward`, to the grains, so that `force` [N] becomes
/// `target`.
void drive_wall(Run&, int servo, int k, const dem::Vec3& inward, double target, double force);

/// Stress that this specimen is to be held at [Pa].
double test_stress(const Run&);

/// Adds a step to the row under way; closes it as the mean over its steps when `position` (0 at the
/// start of the test, 1 at its end) has passed the row's share. True: it was the last.
bool add_to_row(Run&, const std::vector<double>& values, double position);

/// Of a consolidation, each step: `errors` of the stresses over the target. True when their means
/// since the last look are within Test/Tolerance and the grains are at rest. Throws InputError when
/// Test/Consolidation time is over before.
bool consolidated(Run&, const Stage&, const std::vector<double>& errors);

/// d sqrt(rho/p): over the time that a shear strain of one takes, the inertial number (MiDi 2004).
double inertial_time(const Scene&, double grain_size, double stress);

/// Stage names such as "shear 50 kPa".
std::string stress_name(const std::string& what, double stress);

}  // namespace trackbed::apps
