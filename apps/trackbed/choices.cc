#include "apps/trackbed/choices.h"

#include "dem/grading/curve.h"
#include "dem/grading/sieve_size.h"
#include "dem/grain/library.h"

namespace trackbed::apps {

std::vector<std::string> grain_generators() { return dem::generator_names(); }

std::vector<std::string> sieve_methods() { return dem::sieve_method_names(); }

std::vector<std::string> gradation_curves() { return dem::curve_names(); }

std::vector<std::string> contact_laws() { return {"stored_energy", "shao2017"}; }

std::vector<std::string> subgrade_models() { return {"rigid", "layered_elastic"}; }

std::vector<Parameter> subgrade_parameters() { return {}; }

}  // namespace trackbed::apps
