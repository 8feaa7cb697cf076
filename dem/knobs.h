// The grain engine's knobs, each declared in the folder of what it turns.
#pragma once
#include <vector>

#include "base/knob.h"

namespace trackbed::dem {

std::vector<Knob> motion_knobs();
std::vector<Knob> contact_knobs();
std::vector<Knob> grading_knobs();
std::vector<Knob> grain_knobs();
std::vector<Knob> packing_knobs();

}  // namespace trackbed::dem
