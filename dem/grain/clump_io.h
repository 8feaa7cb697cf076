// Clumps from files.
#pragma once
#include <string>
#include <vector>

#include "dem/grain/sphere_union.h"

namespace trackbed::dem {

/// One clump a file: CSV, a line a sphere, "x,y,z,r" in the unit `unit` [m]; a first line of names
/// and empty lines are skipped. Throws InputError "path: line n: problem": not four numbers, a
/// number that is not finite, a radius that is not positive; no sphere; unreadable.
std::vector<Sphere> read_clump(const std::string& path, double unit = 1);

}  // namespace trackbed::dem
