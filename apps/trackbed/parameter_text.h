// What a parameter's text may be: its range in words, and whether a value is within it.
#pragma once
#include <string>
#include <vector>

#include "base/parameter.h"

namespace trackbed::apps {

/// "Section/Key", or "Key" at the top level.
std::string parameter_path(const Parameter&);

/// What is allowed, for messages and documentation: "from 0 to 0.49999", "at least 1",
/// "rigid or elastic".
std::string allowed_text(const Parameter&);

/// "a, b or c"
std::string join_names(const std::vector<std::string>& names);

/// "" if `value` is of the parameter's kind and in range; else what is wrong with it, such as
/// "is not a number" or "is out of range".
std::string fault_of(const Parameter&, const std::string& value);

/// Without the white space at its ends.
std::string trimmed(const std::string& text);

/// The whole of `text` as a finite number; false if it is not one.
bool parse_number(const std::string& text, double& value);

/// A comma-separated list of numbers; false if it is not one. Empty text is an empty list.
bool parse_numbers(const std::string& text, std::vector<double>& values);

}  // namespace trackbed::apps
