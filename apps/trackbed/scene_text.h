// The text of a parameter file, taken apart but not yet understood: which key is given which
// value, and where. deal.II's prm syntax (subsection, set, end, include, # comments, \ at a line's
// end to go on) and JSON (objects are sections; deal.II's own JSON output is read too).
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

/// One `set`: section path ("Subgrade/Layers"; empty at the top), key, value, and its place.
struct SceneEntry {
  std::string section, key, value;
  std::string file;  ///< as the user gave it, or "--set"
  int line = 0;      ///< from 1; 0 for --set

  std::string path() const { return section.empty() ? key : section + "/" + key; }
  std::string place() const { return line > 0 ? file + ":" + std::to_string(line) : file; }
};

/// All entries of a .prm or .json file in order, those of included files in their place
/// (an include's path is relative to the folder of the file that names it).
/// Throws InputError with file and line: no such file, broken syntax, a key set twice in one file.
std::vector<SceneEntry> read_scene_text(const std::string& file);

/// "Section/Key=value" as an entry. Throws InputError.
SceneEntry parse_override(const std::string& text);

}  // namespace trackbed::apps
