#include "apps/trackbed/parameter_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace trackbed::apps {
namespace {

bool is_true_or_false(const std::string& value) {
  for (const char* word : {"true", "false", "yes", "no", "on", "off"})
    if (value == word) return true;
  return false;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

}  // namespace

std::string parameter_path(const Parameter& parameter) {
  return parameter.section.empty() ? parameter.key : parameter.section + "/" + parameter.key;
}

std::string join_names(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

std::string allowed_text(const Parameter& p) {
  switch (p.kind) {
    case ParameterKind::boolean:
      return "true or false";
    case ParameterKind::text:
      return "any text";
    case ParameterKind::choice:
      return join_names(p.choices);
    default:
      break;
  }
  std::string text = p.kind == ParameterKind::integer   ? "a whole number"
                     : p.kind == ParameterKind::numbers ? "numbers separated by commas, each"
                                                        : "a number";
  if (std::isfinite(p.least) && std::isfinite(p.most))
    return text + " from " + short_number(p.least) + " to " + short_number(p.most);
  if (std::isfinite(p.least)) return text + " of at least " + short_number(p.least);
  if (std::isfinite(p.most)) return text + " of at most " + short_number(p.most);
  return text;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

bool parse_number(const std::string& text, double& value) {
  if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string::npos) return false;
  std::size_t used = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    return false;
  }
  return used == text.size() && std::isfinite(value);
}

bool parse_numbers(const std::string& text, std::vector<double>& values) {
  values.clear();
  if (text.find_first_not_of(" \t") == std::string::npos) return true;
  for (std::size_t at = 0; at <= text.size();) {
    const auto comma = std::min(text.find(',', at), text.size());
    std::string piece = text.substr(at, comma - at);
    piece.erase(0, piece.find_first_not_of(" \t"));
    piece.erase(piece.find_last_not_of(" \t") + 1);
    double value = 0;
    if (!parse_number(piece, value)) return false;
    values.push_back(value);
    at = comma + 1;
  }
  return true;
}

std::string fault_of(const Parameter& p, const std::string& value) {
  const auto outside = [&p](double x) { return x < p.least || x > p.most; };
  double x = 0;
  std::vector<double> list;
  switch (p.kind) {
    case ParameterKind::number:
      if (!parse_number(value, x)) return "is not a number";
      return outside(x) ? "is out of range" : "";
    case ParameterKind::integer:
      if (!parse_number(value, x) || value.find_first_of(".eE") != std::string::npos)
        return "is not a whole number";
      return outside(x) ? "is out of range" : "";
    case ParameterKind::numbers:
      if (!parse_numbers(value, list)) return "is not a list of numbers";
      return std::any_of(list.begin(), list.end(), outside) ? "is out of range" : "";
    case ParameterKind::boolean:
      return is_true_or_false(value) ? "" : "is neither true nor false";
    case ParameterKind::choice:
      return std::find(p.choices.begin(), p.choices.end(), value) != p.choices.end()
                 ? ""
                 : "is not one of the choices";
    case ParameterKind::text:
      return "";
  }
  return "";
}

}  // namespace trackbed::apps
