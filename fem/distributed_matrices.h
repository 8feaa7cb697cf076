// Matrices of a body by rows over the ranks of mpirun. Internal: PETSc and deal.II.
//
// p4est's partition of the cells says who integrates a cell; an unknown belongs to the lowest rank
// that has a cell at it, and rows are numbered rank after rank.
#pragma once
#include <petscksp.h>

#include <memory>
#include <vector>

#include "fem/elastic_body.h"
#include "fem/grid.h"

namespace trackbed::fem {

class DistributedVector;

struct DistributedMatrices {
  ElasticBodyParameters p;
  Grid grid;
  Discretisation body;
  Unknowns unknowns;
  bool held = false, lumped = false, damped = false;
  std::vector<int> row;           ///< of each unknown
  std::vector<int> rows_of_rank;  ///< how many each rank owns
  int first_row = 0, own_rows = 0;
  Mat stiffness = nullptr, consistent = nullptr;  ///< consistent mass, unless lumped
  Mat damping = nullptr;                          ///< if `damped`: Rayleigh's and the dashpots'
  Mat dashpots = nullptr;                         ///< of boundaries alone, if there are any
  ::Vec diagonal = nullptr;                       ///< lumped mass
  std::vector<double> node_mass;                  ///< on all ranks [kg]
  std::unique_ptr<DistributedVector> gravity_force;
  DistributedVector& gravity;
  std::vector<int> owner_of_cell;  ///< rank

  explicit DistributedMatrices(ElasticBodyParameters);
  ~DistributedMatrices();
  DistributedMatrices(const DistributedMatrices&) = delete;
  DistributedMatrices& operator=(const DistributedMatrices&) = delete;

  void multiply_stiffness(const DistributedVector& x, DistributedVector& y) const;
  void multiply_damping(const DistributedVector& x, DistributedVector& y) const;  ///< if `damped`
  void multiply_mass(const DistributedVector& x, DistributedVector& y) const;
  void divide_by_mass(DistributedVector& x) const;  ///< lumped only
  void solve_mass(const DistributedVector& f, DistributedVector& a) const;
  double mass_product(const DistributedVector& x, DistributedVector& work) const;
  double stiffness_product(const DistributedVector& x, DistributedVector& work) const;
  /// √ of the largest eigenvalue of M⁻¹A with the lumped mass, 2 % safe.
  double largest_root(Mat) const;
  double mass() const;
  double least_mass(const std::vector<int>& nodes) const;
  std::vector<Vec> at_nodes(const std::vector<double>& unknowns_of_all) const;
  int own_row(int unknown) const;  ///< -1: another rank's, or held

 private:
  void assemble();
  void add_beds(const std::vector<std::array<double, 3>>& elastic);
};

}  // namespace trackbed::fem
