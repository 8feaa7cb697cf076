// How grains and structures exchange forces and motion: the schedules, by name.
//
// In each of them one force per contact acts on both sides, so that momentum is kept. They differ
// in where the surface is while the grains feel it. W = omega dt of the coupled mode; growth is
// that of the amplitude per step for two masses at W = 0.1 (tests/verification/coupling_exchange).
//
//   predicted      u + dt v + 1/2 dt^2 a of the structure; then one step of it          8e-8 (W^4)
//   explicit       the same, and each structure goes just there (velocity Verlet)       0
//   several_steps  n grain steps along the predicted path, then one structure step of
//                  H = n dt under the force at the end; what the grains' impulse
//                  differs from the structure's, H/2 (G_old + G), is owed: each exchange
//                  pays half of it. Damped up to about n omega dt = 2, unstable beyond   < 1e-7
//   iterated       the surface is moved until it lies where the force found there puts
//                  it (Aitken's relaxation)                                             0
//   lagged         where it was a step ago: what happens if nothing is predicted     1.8e-3 (W^2)
#pragma once
#include <string>
#include <vector>

#include "dem/motion/motion.h"

namespace trackbed::coupling {

struct Surface;
struct World;

enum class Schedule { predicted, both_explicit, several_steps, iterated, lagged };

struct Exchange {
  Schedule schedule = Schedule::predicted;
  int grain_steps = 1;      ///< per exchange; more than one with several_steps only
  double tolerance = 1e-8;  ///< of `iterated`: what remains to move, over the deepest overlap
  int most_iterations = 50;
};

struct ScheduleName {
  Schedule schedule;
  std::string name, meaning;
};

/// All schedules, the default first.
const std::vector<ScheduleName>& schedules();

/// By name. Throws InputError naming those there are.
Schedule schedule_named(const std::string&);

/// Grain steps from one exchange to the next: one in a world without deforming surfaces.
int steps_per_exchange(const World&);

/// Gives the structures their step for grain steps of dt [s]: grain_steps * dt. Throws InputError
/// when the schedule asks for explicit structures and one is not at this step (naming its limit).
void set_step(World&, double dt);

/// The largest grain step at which the schedule's demands on the structures hold [s]; infinite
/// where it has none. Throws InputError for a structure that never goes explicitly.
double schedule_limit(const World&);

// The parts of an exchange, in the order in which advance() calls them.

/// Asks the structure for its path over the exchange of `duration` [s].
void foresee(Surface&, const Exchange&, double duration);

/// Moves the surface nodes to `share` (0 to 1) of the path; their velocity is the mean over c.dt.
void follow(Surface&, double share, const dem::StepContext& c);

/// For `iterated`: moves nodes and finds contact forces again until the structure, advanced from
/// its state at the step's start with these forces, arrives where the nodes are. Throws RunError
/// when it does not converge.
void iterate(World&, Surface&, const dem::StepContext& c);

/// Work (for the ledger) and impulse of the surface's contact forces over a grain step.
void tally(Surface&, const Exchange&, const dem::StepContext& c);

/// The structure's step of `duration` [s].
void answer(Surface&, const Exchange&, double duration);

}  // namespace trackbed::coupling
