// Which boundaries a Gmsh file names, read from its header alone, so that a missing one is
// reported before anything is computed.
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

/// Names of the physical surfaces in $PhysicalNames, in the order of the file; none if the file
/// has no such section. Throws InputError if the file cannot be read or is not a Gmsh file.
std::vector<std::string> physical_surfaces(const std::string& file);

}  // namespace trackbed::apps
