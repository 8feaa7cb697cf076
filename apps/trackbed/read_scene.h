// From a parameter file to a checked Scene.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Reads a .prm or .json file, then the overrides ("Section/Key=value"), and checks what can be
/// checked without packing: a subgrade and a sleeper's mesh are built for it. Files that it names
/// are relative to its folder.
/// Throws InputError: one line with file, line, key, the value given and what is allowed.
Scene read_scene(const std::string& file, const std::vector<std::string>& overrides = {});

}  // namespace trackbed::apps
