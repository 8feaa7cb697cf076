// Bringing bodies and structures of a scene into its world and taking them out again.
#pragma once
#include "apps/trackbed/simulation/stage.h"
#include "apps/trackbed/simulation/zones.h"

namespace trackbed::apps {

constexpr double wall_thickness = 0.25;  ///< more than the largest grain [m]
constexpr double wall_top = 5;           ///< higher than any loose heap [m]

/// Places and adds grains on those there are: everywhere, or (`beside`) around the sleeper.
void pour_grains(Run&, const GrainBatch&, bool beside);

/// The grains of an exported packing (Packing/Start from). Throws InputError naming file and grain
/// when one lies outside the container.
void place_imported(Run&);

/// Replaces the packed sample by its copies: Packing/Bays of them along the track, Packing/Layers
/// upward. From here on the run has the scene's own width.
void duplicate_sample(Run&);

/// Walls (a mirror where the scene is halved, none at a seam) and the rigid floor.
void add_walls(Run&);

/// The tamping plate, just above the highest grain.
void add_plate(Run&);

/// The rigid sleeper, level, just above the highest grain below it; vertical motion only, as it is
/// lowered.
void add_rigid_sleeper(Run&);

/// Takes plate or rigid sleeper away.
void remove_moving_body(Run&);

/// Removes grains whose centre lies outside the ballast's cross-section, about the sleeper's base:
/// where it is, or where it will be put.
void trim_shoulders(Run&);

/// Builds the structures that the scene names, where the packing's rigid sleeper and floor are,
/// and takes those away.
void place_structures(Run&);

/// Builds the structures only: a checkpoint fills in their state.
void build_structures(Run&);

/// Plate or rigid sleeper: index of the body.
inline int moving_body(const Run& run) { return run.world.bodies.grains + run.actors.walls; }

/// The load on plate or sleeper from now on [N].
void apply_load(Run&, double newton);

/// The rail pads' answer to a load that goes evenly from `before` to the present one in dt [s].
void compress_pads(Run&, double before, double dt);

/// Stored in the springs of all rail pads [J].
double pads_energy(const Run&);

/// Of a push's actuator [N/m]: the scene's, or the most that a sleeper of this mass [kg] bears at
/// steps of dt [s], k = (0.01/dt)^2 m. The force is found a step late, so its dashpot feeds those
/// vibrations of an elastic sleeper that turn by more than a quarter in that time.
double push_stiffness(const LoadingScene&, double mass, double dt);

/// The actuator of a push stands at `target` from its start [m]: the force of its spring and
/// dashpot (half of critical) on the sleeper from now on.
void apply_push(Run&, double target);

/// The sleeper's displacement along the push against where it was put in [m]: of an elastic one
/// the mean over its surface's nodes. The face that is pushed would show its vibrations, which the
/// late force would feed.
double push_displacement(const Run&);

/// Highest point of the grains within a plan-view rectangle [m].
double highest_grain(const Run&, double low_x, double high_x, double low_y, double high_y);

}  // namespace trackbed::apps
