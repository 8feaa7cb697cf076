// How a library describes its own parameters: plain data. `apps` turns them into
// ParameterHandler sections, into `trackbed parameters` and into the documentation.
#pragma once
#include <limits>
#include <string>
#include <vector>

namespace trackbed {

enum class ParameterKind { number, integer, boolean, choice, text, numbers };

/// One parameter: `section` is its path in the file ("Contact", "Subgrade/Layers"), `fallback`
/// its default as written in a file, `unit` SI or "-", [least, most] its range (numbers and
/// integers, each of `numbers`, a comma-separated list), `choices` the allowed words (choice).
struct Parameter {
  std::string section, key, fallback, unit, meaning;
  ParameterKind kind = ParameterKind::number;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices;
};

}  // namespace trackbed
