#include "apps/trackbed/choices.h"

namespace trackbed::apps {

std::vector<std::string> grain_generators() { return {"voronoi", "ellipsoid_hull"}; }

std::vector<std::string> sieve_methods() {
  return {"exact", "shao2017", "elias2014", "equal_sphere", "equal_cube"};
}

std::vector<std::string> gradation_curves() { return {"shao_wide", "shao_large", "shao_small"}; }

std::vector<std::string> contact_laws() { return {"stored_energy", "shao2017"}; }

std::vector<std::string> subgrade_models() { return {"rigid", "layered_elastic"}; }

std::vector<Parameter> subgrade_parameters() { return {}; }

}  // namespace trackbed::apps
