// The values of all parameters of a scene: defaults, overridden by the entries of a file. The only
// place that knows deal.II's ParameterHandler, which keeps the values and prints them.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "apps/trackbed/scene_text.h"
#include "base/parameter.h"

namespace trackbed::apps {

class ParameterValues {
 public:
  /// Refuses entries with an unknown section or key, of a wrong kind or out of range: InputError,
  /// one line with the entry's place, the nearest known name or what is allowed.
  ParameterValues(const std::vector<Parameter>& table, const std::vector<SceneEntry>& entries);

  const std::string& text(const std::string& path) const;
  double number(const std::string& path) const;
  long long integer(const std::string& path) const;
  bool boolean(const std::string& path) const;
  std::vector<double> numbers(const std::string& path) const;

  /// Where the value was given: "box.prm:12: Container/Length", or only the key for a default.
  std::string where(const std::string& path) const;

  /// Throws InputError: the value's place, what was given, why that will not do.
  [[noreturn]] void refuse(const std::string& path, const std::string& why) const;

  const std::map<std::string, std::string>& all() const { return values_; }

  /// As a parameter file with all values.
  std::string printed() const { return printed_; }

 private:
  std::map<std::string, std::string> values_, places_;
  std::string printed_;
};

enum class ParameterFormat { prm, json };

/// All parameters with their defaults and documentation, by ParameterHandler.
std::string print_defaults(const std::vector<Parameter>& table, ParameterFormat format);

}  // namespace trackbed::apps
