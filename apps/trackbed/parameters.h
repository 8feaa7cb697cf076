// Every parameter of a scene, as plain data: the one table behind parameter files, --set,
// `trackbed parameters` and the documentation.
#pragma once
#include <string>
#include <vector>

#include "base/parameter.h"

namespace trackbed::apps {

/// In the order in which they are printed. Defaults are the ballast box of Shao et al. 2017.
std::vector<Parameter> scene_parameters();

}  // namespace trackbed::apps
