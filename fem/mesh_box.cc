// The box mesh: layers bottom to top, boundaries x_min, x_max, y_min, y_max, bottom, top.
#include <deal.II/grid/grid_generator.h>

#include "base/error.h"
#include "fem/mesh.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

[[noreturn]] void refuse(const ElasticBodyParameters& p, const std::string& what) {
  throw InputError(text(p.name, ": mesh: ", what));
}

std::vector<double> widths(const ElasticBodyParameters& p, int axis) {
  const MeshParameters& m = p.mesh;
  if (!m.widths[axis].empty()) {
    for (double w : m.widths[axis])
      if (!(w > 0)) refuse(p, text("cell width ", w, " m, must be positive"));
    return m.widths[axis];
  }
  if (!(m.lengths[axis] > 0))
    refuse(p, text("length ", m.lengths[axis], " m along ", "xyz"[axis], ", must be positive"));
  if (m.elements[axis] < 1)
    refuse(p, text(m.elements[axis], " elements along ", "xyz"[axis], ", must be 1 or more"));
  return std::vector<double>(m.elements[axis], m.lengths[axis] / m.elements[axis]);
}

}  // namespace

void make_box(const ElasticBodyParameters& p, Grid& grid) {
  const MeshParameters& m = p.mesh;
  std::vector<std::vector<double>> steps(3);
  steps[0] = widths(p, 0);
  steps[1] = widths(p, 1);
  std::vector<int> material;  // of each horizontal row of cells
  if (m.layers.empty()) {
    steps[2] = widths(p, 2);
    material.assign(steps[2].size(), 0);
  }
  for (const Layer& layer : m.layers) {
    if (!(layer.thickness > 0))
      refuse(p, text("layer thickness ", layer.thickness, " m, must be positive"));
    if (layer.elements < 1)
      refuse(p, text("layer with ", layer.elements, " elements, must be 1 or more"));
    if (layer.material < 0 || layer.material >= static_cast<int>(p.materials.size()))
      refuse(p,
             text("layer with material ", layer.material, ", but there are ", p.materials.size()));
    for (int e = 0; e < layer.elements; ++e) {
      steps[2].push_back(layer.thickness / layer.elements);
      material.push_back(layer.material);
    }
  }
  dealii::Point<3> low, high;
  for (int d = 0; d < 3; ++d) {
    low[d] = high[d] = m.corner[d];
    for (double w : steps[d]) high[d] += w;
  }
  dealii::GridGenerator::subdivided_hyper_rectangle(grid.cells, steps, low, high, true);
  std::vector<double> top(steps[2].size());
  double z = low[2];
  for (std::size_t k = 0; k < top.size(); ++k) top[k] = z += steps[2][k];
  for (const auto& cell : grid.cells.active_cell_iterators()) {
    std::size_t k = 0;
    while (k + 1 < top.size() && cell->center()[2] > top[k]) ++k;
    cell->set_material_id(material[k]);
  }
  grid.boundaries = {{"x_min", 0}, {"x_max", 1},  {"y_min", 2},
                     {"y_max", 3}, {"bottom", 4}, {"top", 5}};
}

}  // namespace trackbed::fem
