// One cell's integrals. Internal: works with deal.II's FEValues.
//
// Standard element: K_ab = ∫ λ ∇N_a⊗∇N_b + μ (∇N_b⊗∇N_a + ∇N_a·∇N_b I) dV.
// Mean dilatation (Hughes 1980): the volumetric part uses the mean of ∇N over the cell, for order 2
// its projection on linear functions.
// Incompatible modes (Taylor, Beresford, Wilson 1976): three more functions 4t(1−t) a direction,
// their gradients mapped by the Jacobian at the centre and scaled by det J0 / det J, so that they
// pass the patch test; eliminated in the cell.
#pragma once
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include "fem/grid.h"

namespace trackbed::fem {

class ElementIntegrals {
 public:
  ElementIntegrals(const ElasticBodyParameters&, const Grid&);

  using Cell = dealii::DoFHandler<3>::active_cell_iterator;

  /// Fills stiffness (3n x 3n, index 3 node + direction) and mass (n x n).
  void compute(const Cell&);
  /// Goes past a cell. deal.II takes over from the cell before what it can: only who visits all
  /// cells gets the same bits for each.
  void pass(const Cell& cell) { values_.reinit(cell); }
  dealii::FullMatrix<double> stiffness, mass;

  /// Mean E, ν, ρ of the points of the last cell computed.
  std::array<double, 3> mean_elastic() const;

  /// Stress at the cell's centre for its nodal displacements.
  std::array<double, 6> centre_stress(const Cell&, const std::vector<Vec>& displacement);

 private:
  void evaluate_material(const Cell&, const dealii::FEValues<3>&);

  void project_dilatation();

  std::vector<std::shared_ptr<const MaterialModel>> models_;
  Element element_;
  double top_;
  dealii::FEValues<3> values_, centre_;
  MaterialInputs in_;
  MaterialOutputs out_;
  std::vector<dealii::Tensor<1, 3>> dilatation_;  // point after point
  dealii::FullMatrix<double> full_, inner_, coupling_, product_;
};

/// The materials' models, checked. \throws InputError.
std::vector<std::shared_ptr<const MaterialModel>> models_of(const ElasticBodyParameters&);

}  // namespace trackbed::fem
