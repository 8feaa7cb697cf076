#include "fem/cell_points.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>

#include "fem/grid.h"

namespace trackbed::fem {

CellPoints cell_points(const Grid& grid, int order, const std::vector<int>& cells) {
  dealii::FEValues<3> values(
      grid.shape, dealii::QGauss<3>(order + 1),
      dealii::update_gradients | dealii::update_JxW_values | dealii::update_quadrature_points);
  double top = -1e300;
  for (const auto& x : grid.cells.get_vertices()) top = std::max(top, x[2]);
  CellPoints p;
  p.nodes = static_cast<int>(values.dofs_per_cell);
  p.points = static_cast<int>(values.n_quadrature_points);
  auto wanted = cells.begin();
  int number = 0;
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    if (wanted == cells.end()) break;
    values.reinit(cell);  // takes over from the cell before what it can: pass all, for the same bits
    if (number++ != *wanted) continue;
    ++wanted;
    std::vector<double> mean(3 * p.nodes, 0.);
    double volume = 0;
    for (int q = 0; q < p.points; ++q) {
      for (int a = 0; a < p.nodes; ++a)
        for (int d = 0; d < 3; ++d) {
          const double g = values.shape_grad(a, q)[d];
          p.gradient.push_back(g);
          mean[3 * a + d] += values.JxW(q) * g;
        }
      p.weight.push_back(values.JxW(q));
      p.depth.push_back(top - values.quadrature_point(q)[2]);
      volume += values.JxW(q);
    }
    if (order == 1)
      for (const double m : mean) p.mean.push_back(m / volume);
    ++p.cells;
  }
  return p;
}

void strain_matrix(const CellPoints& p, int cell, int point, std::vector<double>& B) {
  const int n = p.nodes;
  B.assign(18 * n, 0.);
  const double* g = &p.gradient[3l * n * (cell * p.points + point)];
  const double* mean = p.mean.empty() ? nullptr : &p.mean[3l * n * cell];
  const auto at = [&](int component, int a, int d) -> double& {
    return B[3 * (n * component + a) + d];
  };
  for (int a = 0; a < n; ++a) {
    const double* s = g + 3 * a;
    for (int d = 0; d < 3; ++d) at(d, a, d) = s[d];
    at(3, a, 1) = s[2], at(3, a, 2) = s[1];
    at(4, a, 0) = s[2], at(4, a, 2) = s[0];
    at(5, a, 0) = s[1], at(5, a, 1) = s[0];
    if (mean)
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d) at(c, a, d) += (mean[3 * a + d] - s[d]) / 3;
  }
}

}  // namespace trackbed::fem
