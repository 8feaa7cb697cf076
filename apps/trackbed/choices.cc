#include "apps/trackbed/choices.h"

#include "coupling/exchange.h"
#include "dem/contact/pair_forces.h"
#include "dem/contact/round_forces.h"
#include "dem/grading/curve.h"
#include "dem/grading/sieve_size.h"
#include "dem/grain/library.h"
#include "fem/linear_solver.h"
#include "fem/subgrades/registry.h"
#include "fem/time_integration.h"

namespace trackbed::apps {

std::vector<std::string> grain_generators() { return dem::generator_names(); }

std::vector<std::string> grain_shapes() { return {"polyhedron", "dilated", "clump", "sphere"}; }

std::vector<std::string> sieve_methods() { return dem::sieve_method_names(); }

std::vector<std::string> gradation_curves() { return dem::curve_names(); }

std::vector<std::string> contact_laws() { return dem::pair_law_names(); }

std::vector<std::string> round_laws() { return dem::round_law_names(); }

std::vector<std::string> subgrade_models() {
  std::vector<std::string> names{"rigid"};
  for (const auto& entry : fem::subgrade_models()) names.push_back(entry.first);
  return names;
}

std::vector<std::string> waveforms() { return {"sine", "haversine", "triangle", "table"}; }

std::vector<std::string> reductions() { return {"none", "condensed", "modal"}; }

std::vector<std::string> grain_tests() {
  return {"none", "angle_of_repose", "direct_shear", "triaxial"};
}

std::vector<std::string> time_schemes() { return fem::time_scheme_names(); }

std::vector<std::string> linear_solvers() { return fem::solver_names(); }

std::vector<std::string> exchange_schedules() {
  std::vector<std::string> names;
  for (const auto& s : coupling::schedules()) names.push_back(s.name);
  return names;
}

std::vector<Parameter> subgrade_parameters() {
  std::vector<Parameter> table;
  for (const auto& [name, model] : fem::subgrade_models())
    for (Parameter p : model.parameters) {
      p.section = "Subgrade/" + name;
      table.push_back(p);
    }
  return table;
}

std::string section_documentation(const std::string& section) {
  for (const auto& [name, model] : fem::subgrade_models())
    if (section == "Subgrade/" + name) return model.documentation;
  return "";
}

}  // namespace trackbed::apps
