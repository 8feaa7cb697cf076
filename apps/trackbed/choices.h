// The names that a parameter file may choose from, taken from the libraries that own them.
#pragma once
#include <string>
#include <vector>

#include "base/parameter.h"

namespace trackbed::apps {

std::vector<std::string> grain_generators();
std::vector<std::string> grain_shapes();
std::vector<std::string> sieve_methods();
std::vector<std::string> gradation_curves();  ///< without "table"
std::vector<std::string> contact_laws();
std::vector<std::string> round_laws();
std::vector<std::string> subgrade_models();  ///< "rigid" first
std::vector<std::string> waveforms();
std::vector<std::string> reductions();
std::vector<std::string> grain_tests();  ///< "none" first
std::vector<std::string> time_schemes();
std::vector<std::string> linear_solvers();
std::vector<std::string> exchange_schedules();  ///< the default first

/// Parameters that the subgrade models bring along, each in the section "Subgrade/<model>".
std::vector<Parameter> subgrade_parameters();

/// What a section is about: a subgrade model's own words; "" for the others.
std::string section_documentation(const std::string& section);

}  // namespace trackbed::apps
