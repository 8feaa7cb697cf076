#include "apps/trackbed/mesh_names.h"

#include <sstream>

#include "apps/trackbed/files.h"
#include "base/error.h"

namespace trackbed::apps {

std::vector<std::string> physical_surfaces(const std::string& file) {
  std::istringstream in(read_text(file));
  std::vector<std::string> names;
  std::string line;
  if (!std::getline(in, line) || line.rfind("$MeshFormat", 0) != 0)
    throw InputError(file + ": is not a Gmsh mesh (.msh, version 2 or 4, ASCII)");
  while (std::getline(in, line) && line.rfind("$PhysicalNames", 0) != 0) {
  }
  std::getline(in, line);  // their number
  while (std::getline(in, line) && line.rfind("$End", 0) != 0) {
    std::istringstream row(line);
    int dimension = 0;
    row >> dimension;
    const auto open = line.find('"'), close = line.rfind('"');
    if (dimension == 2 && open != std::string::npos && close > open)
      names.push_back(line.substr(open + 1, close - open - 1));
  }
  return names;
}

}  // namespace trackbed::apps
