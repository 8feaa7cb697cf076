// `trackbed parameters`: the table of all parameters in three forms.
#include <cstdio>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/parameters.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

/// A cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string markdown(const std::vector<Parameter>& table) {
  std::string text = "# Parameters of a scene\n";
  std::string section = "?";
  for (const auto& p : table) {
    if (p.section != section) {
      section = p.section;
      text += "\n## " + (section.empty() ? "Outside of sections" : section) +
              "\n\n| Key | Default | Unit | Allowed | Meaning |\n|---|---|---|---|---|\n";
    }
    text += "| " + cell(p.key) + " | " + (p.fallback.empty() ? "" : "`" + cell(p.fallback) + "`") +
            " | " + cell(p.unit) + " | " + cell(allowed_text(p)) + " | " + cell(p.meaning) + " |\n";
  }
  return text;
}

}  // namespace

int parameters_command(const ParametersOptions& options) {
  const auto table = scene_parameters();
  std::string text;
  if (options.format == "markdown")
    text = markdown(table);
  else if (options.format == "prm" || options.format == "json")
    text = print_defaults(table,
                          options.format == "json" ? ParameterFormat::json : ParameterFormat::prm);
  else
    throw InputError("--format '" + options.format + "': allowed: prm, json or markdown");
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) != 0) throw RunError("the parameters cannot be printed (disk full?)");
  return 0;
}

}  // namespace trackbed::apps
