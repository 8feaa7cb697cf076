#include "apps/trackbed/scene_text.h"

#include <filesystem>
#include <map>

#include "apps/trackbed/files.h"
#include "apps/trackbed/json_text.h"
#include "apps/trackbed/parameter_text.h"
#include "base/error.h"
#include "dem/grain/nearest_name.h"

namespace trackbed::apps {
namespace {

/// The first word in lower case if it is one of the file's commands, and what follows it.
std::string take_word(const std::string& line, std::string& rest) {
  const auto end = line.find_first_of(" \t");
  rest = end == std::string::npos ? "" : trimmed(line.substr(end));
  return line.substr(0, end);
}

std::string parent(const std::string& section) {
  const auto slash = section.rfind('/');
  return slash == std::string::npos ? "" : section.substr(0, slash);
}

class PrmReader {
 public:
  explicit PrmReader(std::vector<SceneEntry>& entries) : entries_(entries) {}

  void read(const std::string& file, int depth) {
    if (depth > 8) throw InputError(file + ": files include each other without end");
    const std::string text = read_text(file);
    std::string section;
    std::vector<int> opened;  // lines of the subsections that are open
    std::map<std::string, int> seen;
    std::string line, pending;
    int number = 0, first = 0;
    for (std::size_t at = 0; at < text.size();) {
      const auto end = std::min(text.find('\n', at), text.size());
      line = text.substr(at, end - at);
      at = end + 1;
      ++number;
      line = trimmed(line.substr(0, line.find('#')));
      if (pending.empty()) first = number;
      if (!line.empty() && line.back() == '\\') {
        pending += line.substr(0, line.size() - 1);
        continue;
      }
      line = trimmed(pending + line);
      pending.clear();
      if (line.empty()) continue;

      const SceneEntry here{section, "", "", file, first};
      std::string rest;
      const std::string word = take_word(line, rest);
      if (word == "subsection" || word == "SUBSECTION") {
        if (rest.empty()) throw InputError(here.place() + ": subsection without a name");
        section += (section.empty() ? "" : "/") + rest;
        opened.push_back(first);
      } else if (word == "end" || word == "END") {
        if (opened.empty()) throw InputError(here.place() + ": 'end' without an open subsection");
        section = parent(section);
        opened.pop_back();
      } else if (word == "set" || word == "SET") {
        const auto equals = rest.find('=');
        SceneEntry entry = here;
        entry.key = trimmed(rest.substr(0, equals));
        if (equals == std::string::npos || entry.key.empty())
          throw InputError(here.place() + ": '" + line + "' is not of the form 'set Key = value'");
        entry.value = trimmed(rest.substr(equals + 1));
        const auto [earlier, fresh] = seen.emplace(entry.path(), first);
        if (!fresh)
          throw InputError(here.place() + ": " + entry.path() + " is set twice, first in line " +
                           std::to_string(earlier->second));
        entries_.push_back(entry);
      } else if (word == "include" || word == "INCLUDE") {
        if (!opened.empty())
          throw InputError(here.place() + ": 'include' stands outside of subsections only");
        const auto other = std::filesystem::path(file).parent_path() / rest;
        if (rest.empty() || !std::filesystem::is_regular_file(other))
          throw InputError(here.place() + ": include " + rest + ": no such file (" +
                           other.string() + ")");
        read(other.string(), depth + 1);
      } else {
        throw InputError(here.place() + ": '" + word + "' is not a command; nearest: '" +
                         dem::nearest_name(word, {"subsection", "set", "end", "include"}) + "'");
      }
    }
    if (!opened.empty())
      throw InputError(file + ":" + std::to_string(opened.back()) + ": subsection " + section +
                       " has no 'end'");
  }

 private:
  std::vector<SceneEntry>& entries_;
};

}  // namespace

std::vector<SceneEntry> read_scene_text(const std::string& file) {
  if (std::filesystem::path(file).extension() == ".json")
    return read_json_text(file, read_text(file));
  std::vector<SceneEntry> entries;
  PrmReader(entries).read(file, 0);
  return entries;
}

SceneEntry parse_override(const std::string& text) {
  const auto equals = text.find('=');
  const std::string path = trimmed(text.substr(0, equals));
  if (equals == std::string::npos || path.empty())
    throw InputError("--set '" + text + "': is not of the form 'Section/Key=value'");
  SceneEntry entry;
  entry.section = parent(path);
  entry.key = entry.section.empty() ? path : path.substr(entry.section.size() + 1);
  entry.value = trimmed(text.substr(equals + 1));
  entry.file = "--set '" + text + "'";
  return entry;
}

}  // namespace trackbed::apps
