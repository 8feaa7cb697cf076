// The structures' knobs.
#pragma once
#include <vector>

#include "base/knob.h"

namespace trackbed::fem {

std::vector<Knob> fem_knobs();

}  // namespace trackbed::fem
