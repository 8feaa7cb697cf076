// A mesh from Gmsh: hexahedra, boundaries and materials named by physical groups.
#include <deal.II/grid/grid_in.h>

#include <fstream>

#include "base/error.h"
#include "fem/mesh.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// Names of the physical groups of one dimension: "$PhysicalNames" lists lines: dimension number
// "name".
std::map<int, std::string> physical_names(const std::string& file, int dimension) {
  std::ifstream in(file);
  std::map<int, std::string> names;
  std::string line;
  while (std::getline(in, line))
    if (line.rfind("$PhysicalNames", 0) == 0) break;
  std::getline(in, line);
  while (std::getline(in, line) && line.rfind("$End", 0) != 0) {
    std::istringstream row(line);
    int d = 0, number = 0;
    row >> d >> number;
    const auto open = line.find('"'), close = line.rfind('"');
    if (d == dimension && close > open && open != std::string::npos)
      names[number] = line.substr(open + 1, close - open - 1);
  }
  return names;
}

std::string name_of(const std::map<int, std::string>& names, int number) {
  const auto found = names.find(number);
  return found == names.end() ? std::to_string(number) : found->second;
}

}  // namespace

void read_gmsh(const ElasticBodyParameters& p, Grid& grid) {
  const std::string& file = p.mesh.file;
  const std::string where = text(p.name, ": mesh file '", file, "': ");
  std::ifstream in(file);
  if (!in) throw InputError(where + "cannot be opened");
  dealii::GridIn<3> reader(grid.cells);
  try {
    reader.read_msh(in);
  } catch (const dealii::ExceptionBase& e) {
    throw InputError(where +
                     "not a Gmsh mesh of hexahedra that deal.II can read, or a cell is "
                     "inverted or twisted (" +
                     e.get_exc_name() + "); allowed is .msh version 2 or 4, ASCII");
  } catch (const std::exception&) {
    throw InputError(where + "not a readable Gmsh mesh; allowed is .msh version 2 or 4, ASCII");
  }

  const auto surfaces = physical_names(file, 2), volumes = physical_names(file, 3);
  for (const auto& cell : grid.cells.active_cell_iterators())
    for (unsigned f = 0; f < 6; ++f)
      if (cell->face(f)->at_boundary()) {
        const int id = static_cast<int>(cell->face(f)->boundary_id());
        if (id != 0) grid.boundaries[name_of(surfaces, id)] = id;
      }

  std::map<int, int> material;  // physical volume -> index
  for (const auto& cell : grid.cells.active_cell_iterators()) {
    const int region = static_cast<int>(cell->material_id());
    auto found = material.find(region);
    if (found == material.end()) {
      int index = 0;
      if (!p.mesh.region_material.empty()) {
        auto mapped = p.mesh.region_material.find(name_of(volumes, region));
        if (mapped == p.mesh.region_material.end())
          mapped = p.mesh.region_material.find(std::to_string(region));
        if (mapped == p.mesh.region_material.end())
          throw InputError(where + text("region '", name_of(volumes, region),
                                        "' has no material; given are ",
                                        names_of(p.mesh.region_material)));
        index = mapped->second;
      } else if (p.materials.size() > 1) {
        throw InputError(where + text("several materials, but none is given for region '",
                                      name_of(volumes, region), "'"));
      }
      if (index < 0 || index >= static_cast<int>(p.materials.size()))
        throw InputError(where + text("region '", name_of(volumes, region), "' has material ",
                                      index, ", but there are ", p.materials.size()));
      found = material.emplace(region, index).first;
    }
    cell->set_material_id(found->second);
  }
  const Vec& c = p.mesh.corner;
  if (c[0] != 0 || c[1] != 0 || c[2] != 0) shift(grid, c);
}

}  // namespace trackbed::fem
