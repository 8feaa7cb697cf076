// All knobs of the program, and the ladder that a knob has in a scene.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/scene.h"
#include "base/knob.h"

namespace trackbed::apps {

/// Those of the libraries, then those of scenes: load, domain, grain library.
std::vector<Knob> all_knobs();

/// Each effect as a ladder of two rungs, without and with it (as the scene has it where it is on):
/// what leaving it out does, and what having it costs.
std::vector<Knob> effect_knobs(const Scene&);

/// What errors are measured on; the plots know each by this name (apps/plots/cost.py).
std::vector<std::string> cost_quantities();

struct Rung {
  std::string value;
  double h = 0;      ///< what a fitted order refers to: the value or its inverse; 0 for words
  bool own = false;  ///< the scene's own setting
};

/// From cheap to exact, without repetition. Numbers may lie outside their key's range.
std::vector<Rung> ladder(const Knob&, const Scene&);

/// Does the knob change anything in this scene (Knob::needs)?
bool matters_in(const Knob&, const Scene&);

/// By name. Throws InputError naming the nearest one.
Knob knob_by_name(const std::string& name, const std::vector<Knob>& among = all_knobs());

}  // namespace trackbed::apps
