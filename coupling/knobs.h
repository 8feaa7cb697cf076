// The coupling's knobs.
#pragma once
#include <vector>

#include "base/knob.h"

namespace trackbed::coupling {

std::vector<Knob> coupling_knobs();

}  // namespace trackbed::coupling
