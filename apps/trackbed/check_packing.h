// What a scene's packing asks for, checked before anything is made.
#pragma once
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Throws InputError in one line: place, key, value, what is allowed.
void check_packing(const Scene&, const ParameterValues&);

}  // namespace trackbed::apps
