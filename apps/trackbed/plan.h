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

/// Stiffness of the stiffest contact to expect [N/m]: Eq. 17 of Shao 2017 with flat contact,
/// F = 4E/(3 sqrt(pi)) sqrt(A) depth, over a contact as wide as `share` of the grain.
double contact_stiffness(double modulus, double size, double share = 0.3);

/// Time step [s] for grains of this size [m]: margin * 2/omega, omega^2 = contacts * k/m * (1 +
/// r2), with 4 contacts and r2 = 2.5 for the rotation of a grain (arm d/2, inertia m d^2/10).
double estimated_step(double margin, double modulus, double density, double size);

}  // namespace trackbed::apps
