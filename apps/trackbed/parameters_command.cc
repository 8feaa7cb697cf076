// `trackbed parameters`: the table of all parameters in three forms.
#include <cstdio>

#include "apps/trackbed/choices.h"
#include "apps/trackbed/commands.h"
#include "apps/trackbed/effects.h"
#include "apps/trackbed/parameter_text.h"
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
      const std::string words = section_documentation(section);
      text += "\n## " + (section.empty() ? "Outside of sections" : section) + "\n\n" +
              (words.empty() ? "" : words + "\n\n") +
              "| Key | Default | Unit | Allowed | Meaning |\n|---|---|---|---|---|\n";
    }
    text += "| " + cell(p.key) + " | " + (p.fallback.empty() ? "" : "`" + cell(p.fallback) + "`") +
            " | " + cell(p.unit) + " | " + cell(allowed_text(p)) + " | " + cell(p.meaning) + " |\n";
  }
  return text;
}

/// Files have no place for a section's words: they go to the key that chooses the section.
std::vector<Parameter> with_words_of_sections(std::vector<Parameter> table) {
  for (auto& p : table)
    for (const auto& choice : p.choices) {
      const std::string words = section_documentation(p.section + "/" + choice);
      if (!words.empty()) p.meaning += "\n" + choice + ": " + words;
    }
  return table;
}

}  // namespace

int parameters_command(const ParametersOptions& options) {
  const auto table = scene_parameters();
  std::string text;
  if (options.format == "markdown")
    text = markdown(table) + effects_markdown();
  else if (options.format == "prm" || options.format == "json")
    text = print_defaults(with_words_of_sections(table),
                          options.format == "json" ? ParameterFormat::json : ParameterFormat::prm);
  else
    throw InputError("--format '" + options.format + "': allowed: prm, json or markdown");
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (std::fflush(stdout) != 0) throw RunError("the parameters cannot be printed (disk full?)");
  return 0;
}

}  // namespace trackbed::apps
