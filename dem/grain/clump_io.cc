#include "dem/grain/clump_io.h"

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace trackbed::dem {

std::vector<Sphere> read_clump(const std::string& path, double unit) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be opened");
  std::vector<Sphere> spheres;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto fail = [&](const std::string& problem) {
      throw InputError(path + ": line " + std::to_string(number) + ": " + problem);
    };
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.pop_back();
    if (line.empty() || (number == 1 && std::isalpha(static_cast<unsigned char>(line[0])) &&
                         line.find("nan") != 0 && line.find("inf") != 0))
      continue;
    std::vector<double> values;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      if (end == cell.c_str() || std::string(end).find_first_not_of(" \t") != std::string::npos)
        fail("'" + cell + "' is not a number");
      if (!std::isfinite(value)) fail("'" + cell + "' is not a finite number");
      values.push_back(value);
    }
    if (values.size() != 4) fail("a sphere is four numbers, x,y,z,r");
    if (!(values[3] > 0)) fail("the radius must be positive");
    spheres.push_back({unit * Vec3(values[0], values[1], values[2]), unit * values[3]});
  }
  if (spheres.empty()) throw InputError(path + ": holds no sphere");
  return spheres;
}

}  // namespace trackbed::dem
