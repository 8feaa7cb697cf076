// What a run of a scene would do and cost: grains estimated from the scene alone, structures built
// and timed for a few steps.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// A part of the computation that the scene may leave out.
struct Effect {
  std::string name;
  bool on;
  std::string cost;  ///< what it costs when on; what to set to have it when off
};

struct PlanStage {
  std::string name;
  double duration;     ///< simulated, as is usual [s]
  double longest;      ///< at most [s]
  double time_step;    ///< [s]
  double steps;        ///< of the usual duration
  bool loads;          ///< with the scene's structures
  double seconds = 0;  ///< of computing, of the usual duration
};

struct StructureCost {
  double unknowns = 0;    ///< 0 = rigid
  double seconds = 0;     ///< a step
  bool solves = false;    ///< else explicit
  std::string reduction;  ///< what it leaves out, or iterations of its solver; else empty
};

struct Plan {
  double grains;        ///< in the bed, class by class
  double all_fine = 0;  ///< in bed and beside, if there were no zones; 0 = there are none
  double fill_grains;   ///< put beside the sleeper after packing
  StructureCost sleeper, subgrade;
  std::vector<PlanStage> stages;
  std::vector<Effect> effects;
  double memory;                ///< [bytes]
  double seconds;               ///< of computing, with `threads` threads
  double seconds_all_fine = 0;  ///< if there were no zones; 0 = there are none
};

Plan make_plan(const Scene&, int threads);

}  // namespace trackbed::apps
