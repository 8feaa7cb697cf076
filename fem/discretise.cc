// From deal.II's cells to plain arrays of nodes, cells and oriented boundary faces.
#include <deal.II/base/quadrature.h>
#include <deal.II/dofs/dof_renumbering.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_tools.h>

#include "base/error.h"
#include "fem/grid.h"
#include "fem/mesh.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// Signed volume of the parallelepiped at each vertex: all positive in a valid hexahedron.
void check_cells(const ElasticBodyParameters& p, const Grid& grid) {
  using dealii::Tensor;
  for (const auto& cell : grid.cells.active_cell_iterators())
    for (int v = 0; v < 8; ++v) {
      Tensor<1, 3> e[3];
      double size = 1;
      for (int d = 0; d < 3; ++d) {
        const int other = v ^ (1 << d);
        e[d] = (v >> d & 1) ? cell->vertex(v) - cell->vertex(other)
                            : cell->vertex(other) - cell->vertex(v);
        size *= e[d].norm();
      }
      const double volume = e[0] * dealii::cross_product_3d(e[1], e[2]);
      if (!(volume > 1e-6 * size)) {
        const auto c = cell->center();
        throw InputError(
            text(p.name, ": mesh", p.mesh.file.empty() ? "" : " file '" + p.mesh.file + "'",
                 ": the cell at (", c[0], ", ", c[1], ", ", c[2],
                 ") is inverted or collapsed; every corner must have a positive volume"));
      }
    }
}

// Place in the 3x3 (or 2x2) raster of deal.II's face nodes: vertices, lines, interior.
constexpr int kRaster[2][9] = {{0, 1, 2, 3}, {0, 2, 6, 8, 3, 5, 1, 7, 4}};

}  // namespace

void make_cells(const ElasticBodyParameters& p, Grid& grid) {
  if (p.mesh.file.empty())
    make_box(p, grid);
  else
    read_gmsh(p, grid);
  check_cells(p, grid);
}

void shift(Grid& grid, const Vec& by) {
  dealii::GridTools::shift(dealii::Tensor<1, 3>({by[0], by[1], by[2]}), grid.cells);
}

Discretisation discretise(Grid& grid) {
  grid.nodes.distribute_dofs(grid.shape);
  dealii::DoFRenumbering::Cuthill_McKee(grid.nodes);

  Discretisation body;
  body.boundaries = grid.boundaries;
  body.position.resize(grid.nodes.n_dofs());
  const unsigned per_cell = grid.shape.n_dofs_per_cell(), per_face = grid.shape.n_dofs_per_face();
  body.nodes_per_cell = static_cast<int>(per_cell);

  dealii::FEValues<3> values(grid.shape,
                             dealii::Quadrature<3>(grid.shape.get_unit_support_points()),
                             dealii::update_quadrature_points);
  std::vector<dealii::types::global_dof_index> ids(per_cell), on_face(per_face);
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(ids);
    for (unsigned i = 0; i < per_cell; ++i) {
      const auto& x = values.quadrature_point(i);
      body.position[ids[i]] = {x[0], x[1], x[2]};
      body.cell_nodes.push_back(static_cast<int>(ids[i]));
    }
    for (unsigned f = 0; f < 6; ++f) {
      if (!cell->face(f)->at_boundary()) continue;
      cell->face(f)->get_dof_indices(on_face);
      Face face;
      face.count = static_cast<int>(per_face);
      face.boundary = static_cast<int>(cell->face(f)->boundary_id());
      face.cell = static_cast<int>(cell->active_cell_index());
      const int n = per_face == 4 ? 2 : 3;
      for (unsigned i = 0; i < per_face; ++i)
        face.nodes[kRaster[n - 2][i]] = static_cast<int>(on_face[i]);
      const auto v = [&](int k) { return cell->face(f)->vertex(k); };
      const auto out =
          dealii::cross_product_3d(v(1) - v(0) + v(3) - v(2), v(2) - v(0) + v(3) - v(1));
      if (out * (cell->face(f)->center() - cell->center()) < 0)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < j; ++i) std::swap(face.nodes[j * n + i], face.nodes[i * n + j]);
      body.faces.push_back(face);
    }
  }
  return body;
}

}  // namespace trackbed::fem
