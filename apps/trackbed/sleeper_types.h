// Sleepers by name: what Sleeper/Type sets where the scene does not say otherwise.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/scene_text.h"

namespace trackbed::apps {

/// "block" first: it sets nothing.
std::vector<std::string> sleeper_types();

/// Adds to the entries those of the type that they name (Sleeper/Type), where they are not given.
void apply_sleeper_type(std::vector<SceneEntry>& entries);

}  // namespace trackbed::apps
