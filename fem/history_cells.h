// Cells whose stress a StressModel gives: their quadrature points and what each remembers. All of a
// body's cells, or those that a rank needs.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "fem/cell_points.h"
#include "fem/elastic_body.h"
#include "fem/materials/stress_model.h"

namespace trackbed::fem {

struct Unknowns;

/// What a body of that material is made of: mesh, supports and contact surface as given, lumped
/// mass of that density, no loads, no gravity (the stress in situ bears it), and a stiffness that
/// means nothing. \throws InputError if it has beds.
ElasticBodyParameters history_parameters(ElasticBodyParameters, double density);

/// Unknown of each node and direction of these cells, 3 nodes_per_cell a cell; -1 where held.
std::vector<int> cell_unknowns(const Discretisation&, const Unknowns&,
                               const std::vector<int>& cells);

class HistoryCells {
 public:
  /// `cells`: numbers, ascending. `place`: of their nodes' values in the arrays given to the
  /// functions below, as cell_unknowns() orders them. `own`: whether a cell's energies count here
  /// (a rank's neighbours count theirs themselves).
  HistoryCells(const Grid&, int order, std::shared_ptr<const StressModel>, std::vector<int> cells,
               std::vector<int> place, std::vector<char> own);

  /// Stiffness of a cell, 3n x 3n by rows, and where its rows and columns belong.
  using AddTangent = std::function<void(const int* place, const std::vector<double>& stiffness)>;

  /// Stresses at u, from the history of t: force += ∫Bᵀσ dV, cell after cell; places beyond the end
  /// of `force` are left out. A tangent is made only if `add` is given. The history and the
  /// energies that belong to them wait for commit().
  void evaluate(const std::vector<double>& u, std::vector<double>& force, const AddTangent& add);

  /// The last evaluation's history becomes that of t.
  void commit() { history_.swap(next_); }

  double stored() const { return stored_; }          ///< of the last evaluation, own cells [J]
  double dissipated() const { return dissipated_; }  ///< between t and the last evaluation [J]

  /// Mean stress of each cell [Pa] at u of t.
  std::vector<Voigt> mean_stress(const std::vector<double>& u);

  const std::vector<int>& cells() const { return cells_; }
  bool own(int k) const { return own_[k] != 0; }
  int points() const { return points_.points; }

  /// History of cell after cell, points() * model's history() numbers each.
  std::vector<double>& history() { return history_; }
  const std::vector<double>& history() const { return history_; }
  std::size_t history_of_cell() const { return remembered_; }

 private:
  void find_stress(int k, const std::vector<double>& u, bool want_tangent);
  void add_tangent(const Tangent&, double weight, const std::vector<double>& B);

  CellPoints points_;
  std::shared_ptr<const StressModel> model_;
  std::vector<int> cells_, place_;
  std::vector<char> own_;
  std::size_t remembered_;
  std::vector<double> history_, next_;
  double stored_ = 0, dissipated_ = 0;

  // Of one cell.
  StressInputs in_;
  StressOutputs out_;
  std::vector<std::vector<double>> B_;  // of each point
  std::vector<double> displacement_, force_, stiffness_, weighted_;
};

}  // namespace trackbed::fem
