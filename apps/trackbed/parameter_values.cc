#include "apps/trackbed/parameter_values.h"

#include <deal.II/base/parameter_handler.h>

#include <sstream>

#include "apps/trackbed/parameter_text.h"
#include "base/error.h"
#include "dem/grain/nearest_name.h"

namespace trackbed::apps {
namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;
using dem::nearest_name;

std::unique_ptr<Patterns::PatternBase> pattern_of(const Parameter& p) {
  switch (p.kind) {
    case ParameterKind::number:
      return std::make_unique<Patterns::Double>(p.least, p.most);
    case ParameterKind::integer:
      // Seeds go beyond deal.II's int: the range is checked here, the digits there.
      return std::make_unique<Patterns::Double>(p.least, p.most);
    case ParameterKind::numbers:
      return std::make_unique<Patterns::List>(Patterns::Double(p.least, p.most));
    case ParameterKind::boolean:
      return std::make_unique<Patterns::Bool>();
    case ParameterKind::choice: {
      std::string choices;
      for (const auto& choice : p.choices) choices += (choices.empty() ? "" : "|") + choice;
      return std::make_unique<Patterns::Selection>(choices);
    }
    case ParameterKind::text:
      break;
  }
  return std::make_unique<Patterns::Anything>();
}

std::vector<std::string> levels_of(const std::string& section) {
  std::vector<std::string> levels;
  std::istringstream in(section);
  for (std::string level; std::getline(in, level, '/');) levels.push_back(level);
  return levels;
}

/// Goes into a parameter's section for as long as it lives.
class Inside {
 public:
  Inside(ParameterHandler& handler, const std::string& section) : handler_(handler) {
    for (const auto& level : levels_of(section)) {
      handler_.enter_subsection(level);
      ++depth_;
    }
  }
  ~Inside() {
    for (; depth_ > 0; --depth_) handler_.leave_subsection();
  }

 private:
  ParameterHandler& handler_;
  int depth_ = 0;
};

std::string documentation_of(const Parameter& p) {
  const auto first = std::min(p.meaning.find('\n'), p.meaning.size());  // the rest explains
  std::string text = p.meaning.substr(0, first);
  if (p.unit != "-") text += " [" + p.unit + "]";
  if (p.kind != ParameterKind::text) text += "; " + allowed_text(p);
  return text + p.meaning.substr(first);
}

void declare(ParameterHandler& handler, const std::vector<Parameter>& table) {
  for (const auto& p : table) {
    Inside inside(handler, p.section);
    handler.declare_entry(p.key, p.fallback, *pattern_of(p), documentation_of(p));
  }
}

const Parameter& find_parameter(const std::vector<Parameter>& table, const SceneEntry& entry) {
  std::vector<std::string> sections, keys, elsewhere;
  for (const auto& p : table) {
    if (p.section == entry.section && p.key == entry.key) return p;
    if (!p.section.empty() && (sections.empty() || sections.back() != p.section))
      sections.push_back(p.section);
    if (p.section == entry.section) keys.push_back(p.key);
    if (p.key == entry.key) elsewhere.push_back(parameter_path(p));
  }
  const std::string also =
      elsewhere.empty() ? "" : " ('" + entry.key + "' exists as " + join_names(elsewhere) + ")";
  if (keys.empty())
    throw InputError(entry.place() + ": unknown section '" + entry.section +
                     "'; nearest known section: '" + nearest_name(entry.section, sections) + "'" +
                     also);
  const std::string nearest = nearest_name(entry.key, keys);
  throw InputError(
      entry.place() + ": unknown key '" + entry.key + "'" +
      (entry.section.empty() ? " outside of sections" : " in section '" + entry.section + "'") +
      "; nearest known key: '" + nearest + "'" + also);
}

void check_value(const Parameter& p, const SceneEntry& entry) {
  const std::string fault = fault_of(p, entry.value);
  if (fault.empty()) return;
  std::string message = entry.place() + ": " + entry.path() + " = '" + entry.value + "' " + fault +
                        "; allowed: " + allowed_text(p);
  if (p.unit != "-" && p.kind != ParameterKind::choice) message += " [" + p.unit + "]";
  if (p.kind == ParameterKind::choice)
    message += "; nearest: '" + nearest_name(entry.value, p.choices) + "'";
  throw InputError(message);
}

std::string number_text(const std::string& text) {
  const auto first = text.find_first_not_of('+');
  return first == std::string::npos ? text : text.substr(first);
}

}  // namespace

ParameterValues::ParameterValues(const std::vector<Parameter>& table,
                                 const std::vector<SceneEntry>& entries) {
  ParameterHandler handler;
  declare(handler, table);
  for (const auto& entry : entries) {
    const Parameter& p = find_parameter(table, entry);
    check_value(p, entry);
    places_[entry.path()] = entry.place();
    Inside inside(handler, p.section);
    try {
      const bool word = p.kind == ParameterKind::boolean;
      const bool on = entry.value == "true" || entry.value == "yes" || entry.value == "on";
      handler.set(p.key, word ? std::string(on ? "true" : "false") : number_text(entry.value));
    } catch (const dealii::ExceptionBase&) {
      throw InputError(entry.place() + ": " + entry.path() + " = '" + entry.value +
                       "' is not understood; allowed: " + allowed_text(p));
    }
  }
  for (const auto& p : table) {
    Inside inside(handler, p.section);
    values_[parameter_path(p)] = handler.get(p.key);
  }
  std::ostringstream out;
  handler.print_parameters(out,
                           ParameterHandler::KeepDeclarationOrder | ParameterHandler::ShortText);
  printed_ = out.str();
}

const std::string& ParameterValues::text(const std::string& path) const { return values_.at(path); }

double ParameterValues::number(const std::string& path) const {
  double value = 0;
  parse_number(text(path), value);
  return value;
}

long long ParameterValues::integer(const std::string& path) const { return std::stoll(text(path)); }

bool ParameterValues::boolean(const std::string& path) const { return text(path) == "true"; }

std::vector<double> ParameterValues::numbers(const std::string& path) const {
  std::vector<double> values;
  parse_numbers(text(path), values);
  return values;
}

std::string ParameterValues::where(const std::string& path) const {
  const auto place = places_.find(path);
  return place == places_.end() ? path : place->second + ": " + path;
}

void ParameterValues::refuse(const std::string& path, const std::string& why) const {
  throw InputError(where(path) + " = " + text(path) + ": " + why);
}

std::string print_defaults(const std::vector<Parameter>& table, ParameterFormat format) {
  ParameterHandler handler;
  declare(handler, table);
  std::ostringstream out;
  handler.print_parameters(
      out, ParameterHandler::KeepDeclarationOrder |
               (format == ParameterFormat::json ? ParameterHandler::JSON : ParameterHandler::PRM));
  return out.str();
}

}  // namespace trackbed::apps
