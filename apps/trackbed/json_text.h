// The JSON form of a parameter file: {"Contact": {"Contact modulus": 2e9, ...}, ...}.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/scene_text.h"

namespace trackbed::apps {

/// Objects are sections, arrays become comma-separated lists. deal.II's own output is understood
/// too: a name's special characters written as _20 and the like, an object with a "value" for an
/// entry. Throws InputError with the line.
std::vector<SceneEntry> read_json_text(const std::string& file, const std::string& text);

}  // namespace trackbed::apps
