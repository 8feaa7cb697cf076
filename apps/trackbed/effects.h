// The effects that a scene may ask for: what is on, what it costs, what switches it.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/plan.h"

namespace trackbed::apps {

/// One effect as plain data. What is off is not computed: no branch in the inner loop, no memory.
struct EffectKind {
  std::string name;
  std::string path;     ///< "Section/Key" that switches it
  std::string off, on;  ///< values of that key; `on` an example where there are many
  std::string adds;     ///< to a step, in words
  bool (*is_on)(const Scene&);
  std::string (*cost)(const Scene&, const Plan&);  ///< measured for a scene; null = `adds`
  /// Further "Section/Key=value" that a scene needs when the effect is switched on; null: none.
  std::vector<std::string> (*also)(const Scene&) = nullptr;
};

const std::vector<EffectKind>& effect_kinds();

/// Their state in a scene; costs of structures as the plan has measured them.
std::vector<Effect> effects_of(const Scene&, const Plan&);

/// effects.csv of a run: effect, on, cost_or_switch.
void write_effects(const Scene&, const std::string& file);

/// As rows of a Markdown table, for `trackbed parameters`.
std::string effects_markdown();

}  // namespace trackbed::apps
