// A run is a row of stages; each says which bodies and loads it has, how hard its contacts are,
// and when it is over. Stages are plain data, made from the scene; run_stages() runs them.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "apps/trackbed/grain_tests/state.h"
#include "apps/trackbed/scene.h"
#include "apps/trackbed/simulation/layout.h"
#include "coupling/world.h"
#include "dem/packing/friction_path.h"

namespace trackbed::apps {

/// What stands in the world besides grains. Bodies follow in this order: grains, walls, floor,
/// then the one body that is moved: plate or rigid sleeper.
struct Actors {
  int walls = 0;  ///< fixed boxes; the last one is the floor while `floor` is set
  bool floor = false, plate = false, rigid_sleeper = false;
  bool sample = false;                              ///< one of Packing/Bays stands for all so far
  int sleeper_surface = -1, subgrade_surface = -1;  ///< into World::surfaces, -1 = rigid
  double sleeper_base = 0;   ///< height of the sleeper's base when it was put in [m]
  double sleeper_start = 0;  ///< height of the rigid sleeper's centre then [m]
};

/// A bed at rest on the friction path of quasi-vibration.
struct PathPoint {
  dem::FrictionPoint point;
  double height = 0;        ///< [m]
  double coordination = 0;  ///< contacts per grain
  double unbalanced = 0;    ///< force, over the mean contact force
  double time = 0;          ///< at its end [s]
};

/// Where the run stands; part of every checkpoint.
struct StageState {
  int index = 0;     ///< of the stage under way
  int steps = 0;     ///< done in this stage
  int cycles = 0;    ///< whole load cycles done in this stage
  int halvings = 0;  ///< of the time step in this stage
  int steps_per_cycle = 0;
  double dt = 0;             ///< [s]
  double start = 0;          ///< time at its start [s]
  double friction = 0;       ///< grain on grain in this stage
  double stop_at = 0;        ///< > 0: porosity at which a bed of quasi-vibration is stopped
  double stop_friction = 0;  ///< by this friction
  double load = 0;           ///< on plate or sleeper now [N]
  double pad = 0;            ///< compression of the rail pads now [m]
  double pad_work = 0, pad_loss = 0;  ///< of all pads since the ledger was opened [J]
  double u0 = 0;                      ///< sleeper displacement that counts as zero [m]
  double u_min = 0, load_min = 0, u_max = 0, load_max = 0;  ///< last extremes [m], [N]
  double push_start = 0, push = 0;  ///< sleeper along the push: at its start, and since then [m]
  double push_force = 0;            ///< of the actuator [N]
  double push_stiffness = 0;        ///< of its spring, as the step allows [N/m]
  // Since the last stage that does not go on with the bed of the one before: seating, for a loaded
  // bed.
  double largest_overlap = 0;       ///< depth over grain size
  double largest_step_share = 0;    ///< time step over the measured limit
  std::vector<double> grain_force;  ///< largest contact force per grain [N]
  double work_in = 0;               ///< sum of the rises of the ledger's work [J]
  double last_work = 0;             ///< its last value [J]
  double worst_closure = 0;         ///< largest |closure| since the ledger was opened [J]
  double exchange_gain = 0;         ///< largest energy that the exchange had made since then [J]
  double structure_gain = 0;        ///< the same of the structures' time integration [J]
  /// Of each stage that was to come to rest, at its end: kinetic energy or unbalanced force over
  /// what is allowed, the larger; others 0.
  std::vector<double> unrest;
  std::vector<double> pressure;     ///< under the sleeper, sum over load peaks, by cell [Pa]
  int pressure_samples = 0;
};

struct Run {
  Scene scene;
  Layout layout;
  int threads = 1;
  coupling::World world;
  Actors actors;
  StageState stage;
  GrainTestState test;  ///< of a test of grains
  std::string folder;   ///< results go here
  std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
  double wall_before = 0;                       ///< of earlier parts of a resumed run [s]
  std::vector<PathPoint> path;                  ///< of quasi-vibration, in the order they were made
  std::vector<dem::GrainShape> library;         ///< made when first needed
  std::vector<dem::GrainShape> coarse_library;  ///< of the zones outside, the same
  std::function<void(double)> library_progress;  ///< is told the share of it that is done
};

/// Of the run until now, its earlier parts included [s].
inline double wall_time(const Run& run) {
  const std::chrono::duration<double> part = std::chrono::steady_clock::now() - run.begun;
  return run.wall_before + part.count();
}

struct Stage {
  std::string name;
  double modulus = 0;   ///< contact modulus [Pa]
  double damping = 0;   ///< local damping
  double margin = 0.2;  ///< share of the stability limit
  double friction = 0;  ///< grain on grain
  double longest = 0;   ///< [s]
  double period = 0;    ///< of the load [s]; 0 = no cycles
  double peak = 0.5;    ///< when in a cycle the load is largest, as a share of the period
  bool until_quiet = false;
  std::string aim;        ///< what `after_cycle` waits for, in words; empty = nothing
  double unbalanced = 0;  ///< then also the mean unbalanced force is below this share; 0 = any
  bool ledger = false;    ///< opens the energy ledger at its start
  bool gravity = true;
  bool goes_on = false;  ///< with the bed of the stage before: what its grains bore is kept
  std::function<void(Run&)> enter;  ///< changes bodies and surfaces, and stage.friction
  std::function<double(const Run&, double)> load;  ///< force at a time since the stage's start [N]
  std::function<double(double)> push;     ///< the actuator's place [m] at that time; empty: no push
  std::function<bool(Run&)> after_cycle;  ///< true: the stage is over
  std::function<bool(Run&)> watch;        ///< often; true: stage.friction has changed
  /// After every step: prescribed motions of bodies; true: the stage is over. A stage that has it
  /// closes its energy ledger at its end.
  std::function<bool(Run&, const Stage&)> control;
  std::function<bool(Run&)> again;  ///< once it is over; true: it is entered again
};

/// A stage of the finished bed: the scene's own contacts, the ledger opened, no load, nothing to
/// change at its start.
Stage bed_stage(const Scene&, const std::string& name, double longest, double damping);

/// Deposit, tamping or quasi-vibration, layers, plate off, sleeper and ballast beside it, hardening
/// to the loading modulus.
std::vector<Stage> packing_stages(const Scene&);

/// Seating under the least load, then the load cycles, then the push if there is one; or the
/// scene's test of grains.
std::vector<Stage> loading_stages(const Scene&);

/// What one step of the stage needs.
dem::StepContext step_context(const Run&, const Stage&);

/// Sleeper's displacement, positive downwards, against where it was put in [m].
double sleeper_displacement(const Run&);

/// The same of the rail, beyond its pads.
inline double rail_displacement(const Run& run) {
  return sleeper_displacement(run) + run.stage.pad;
}

/// Height of the bed between the subgrade and the plate [m].
double bed_height(const Run&);

/// Mass of grains per volume between subgrade and plate [kg/m3].
double bed_density(const Run&);

}  // namespace trackbed::apps
