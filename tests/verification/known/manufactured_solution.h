// A manufactured solution on the unit cube, and the error of an answer against it. Looks at
// deal.II.
#pragma once
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cmath>

#include "fem/assembly.h"
#include "fem/grid.h"
#include "fem/supports.h"

namespace trackbed::fem::known {

// u = (s, 2s, −s) with s = sin πx sin πy sin πz on the unit cube, held all around.
inline const double kShare[3] = {1, 2, -1};

/// L² norms of the error and of its gradient.
struct Errors {
  double value, gradient;
  int unknowns;
};

/// n cells a side.
inline Errors manufactured_error(int order, Element element, int n) {
  ElasticBodyParameters p;
  p.mesh.lengths = {1, 1, 1};
  p.mesh.elements = {n, n, n};
  p.order = order;
  p.element = element;
  const double E = 1, nu = 0.3, mu = E / (2 * (1 + nu)),
               lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  p.materials = {{"cube", E, nu, 1}};
  for (const char* side : {"x_min", "x_max", "y_min", "y_max", "bottom", "top"})
    p.supports[side] = Support::fixed;
  Grid grid(order);
  make_cells(p, grid);
  const Discretisation body = discretise(grid);
  const Unknowns unknowns = number_unknowns(body, p.name, p.supports);
  const Assembled a = assemble(p, grid, body, unknowns, false);

  using dealii::Point;
  const auto s = [](const Point<3>& x, int i, int j) {  // s or its derivatives along i and j
    double value = 1;
    for (int d = 0; d < 3; ++d) {
      const int times = (d == i) + (d == j);
      const double t = M_PI * x[d];
      value *= times == 0   ? std::sin(t)
               : times == 1 ? M_PI * std::cos(t)
                            : -M_PI * M_PI * std::sin(t);
    }
    return value;
  };
  dealii::FEValues<3> values(grid.shape, dealii::QGauss<3>(order + 3),
                             dealii::update_values | dealii::update_gradients |
                                 dealii::update_JxW_values | dealii::update_quadrature_points);
  const auto each_point = [&](auto&& visit) {
    std::vector<dealii::types::global_dof_index> ids(grid.shape.n_dofs_per_cell());
    for (const auto& cell : grid.nodes.active_cell_iterators()) {
      values.reinit(cell);
      cell->get_dof_indices(ids);
      for (unsigned q = 0; q < values.n_quadrature_points; ++q) visit(q, ids);
    }
  };

  std::vector<double> f(unknowns.count, 0.), u(unknowns.count, 0.);
  each_point([&](unsigned q, const auto& ids) {
    const Point<3>& x = values.quadrature_point(q);
    for (int d = 0; d < 3; ++d) {  // f = −(λ+μ) ∇ div u − μ Δu
      double force = 3 * M_PI * M_PI * mu * kShare[d] * s(x, -1, -1);
      for (int e = 0; e < 3; ++e) force -= (lambda + mu) * kShare[e] * s(x, d, e);
      for (std::size_t k = 0; k < ids.size(); ++k)
        if (const int i = unknowns.of_node[ids[k]][d]; i >= 0)
          f[i] += force * values.shape_value(k, q) * values.JxW(q);
    }
  });
  Factor(a.matrices.pattern, a.matrices.stiffness, "cube").solve(f, u);

  Errors error{0, 0, 0};
  each_point([&](unsigned q, const auto& ids) {
    const Point<3>& x = values.quadrature_point(q);
    for (int d = 0; d < 3; ++d) {
      double value = -kShare[d] * s(x, -1, -1);
      Vec slope;
      for (int e = 0; e < 3; ++e) slope[e] = -kShare[d] * s(x, e, -1);
      for (std::size_t k = 0; k < ids.size(); ++k)
        if (const int i = unknowns.of_node[ids[k]][d]; i >= 0) {
          value += u[i] * values.shape_value(k, q);
          for (int e = 0; e < 3; ++e) slope[e] += u[i] * values.shape_grad(k, q)[e];
        }
      error.value += value * value * values.JxW(q);
      for (double g : slope) error.gradient += g * g * values.JxW(q);
    }
  });
  return {std::sqrt(error.value), std::sqrt(error.gradient), static_cast<int>(unknowns.count)};
}

}  // namespace trackbed::fem::known
