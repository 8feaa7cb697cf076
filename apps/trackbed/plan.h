// What a run of a scene would do and cost, estimated from the scene alone; nothing is built.
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
  double duration;   ///< simulated [s], at most
  double time_step;  ///< [s]
  double steps;
};

struct Plan {
  double grains;                               ///< in the bed, class by class
  double fill_grains;                          ///< put beside the sleeper after packing
  double sleeper_unknowns, subgrade_unknowns;  ///< 0 = no finite elements
  std::vector<PlanStage> stages;
  std::vector<Effect> effects;
  double memory;   ///< [bytes]
  double seconds;  ///< of computing, with `threads` threads
};

Plan make_plan(const Scene&, int threads);

}  // namespace trackbed::apps
