// Matrices and vectors of a body by rows over the ranks of mpirun. Internal: PETSc and deal.II.
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
  bool held = false, lumped = false;
  std::vector<int> row;           ///< of each unknown
  std::vector<int> rows_of_rank;  ///< how many each rank owns
  int first_row = 0, own_rows = 0;
  Mat stiffness = nullptr, consistent = nullptr;  ///< consistent mass, unless lumped
  ::Vec diagonal = nullptr;                       ///< lumped mass
  std::vector<double> node_mass;                  ///< on all ranks [kg]
  std::unique_ptr<DistributedVector> gravity_force;
  DistributedVector& gravity;
  double omega = 0;  ///< largest_frequency()

  explicit DistributedMatrices(ElasticBodyParameters);
  ~DistributedMatrices();
  DistributedMatrices(const DistributedMatrices&) = delete;
  DistributedMatrices& operator=(const DistributedMatrices&) = delete;

  void multiply_stiffness(const DistributedVector& x, DistributedVector& y) const;
  void multiply_mass(const DistributedVector& x, DistributedVector& y) const;
  void divide_by_mass(DistributedVector& x) const;  ///< lumped only
  void solve_mass(const DistributedVector& f, DistributedVector& a) const;
  double mass_product(const DistributedVector& x, DistributedVector& work) const;
  double stiffness_product(const DistributedVector& x, DistributedVector& work) const;
  double largest_frequency();
  double mass() const;
  double least_mass(const std::vector<int>& nodes) const;
  std::vector<Vec> at_nodes(const std::vector<double>& unknowns_of_all) const;

 private:
  void assemble(const std::vector<int>& owner_of_cell);
};

/// A PETSc vector over the unknowns.
class DistributedVector {
 public:
  DistributedVector() = default;
  DistributedVector(const DistributedVector&);
  DistributedVector(DistributedVector&& other) noexcept : v(other.v) { other.v = nullptr; }
  DistributedVector& operator=(const DistributedVector&) = delete;
  ~DistributedVector();
  void reinit(const DistributedMatrices&);
  void copy(const DistributedVector& x) { VecCopy(x.v, v); }
  void scale(double s) { VecScale(v, s); }
  void add_scaled(double s, const DistributedVector& x) { VecAXPY(v, s, x.v); }
  double dot(const DistributedVector& x) const;
  /// Adds to a node's unknown if this rank owns it; reads it (0 if not).
  void add(const DistributedMatrices&, int node, int direction, double value);
  double own(const DistributedMatrices&, int node, int direction) const;
  /// All values by unknown, on every rank; and back.
  std::vector<double> everywhere(const DistributedMatrices&) const;
  void take(const DistributedMatrices&, const std::vector<double>& all);

  ::Vec v = nullptr;
};

/// (mass_share M + stiffness_share K) x = b, set up once: MUMPS or conjugate gradients with
/// multigrid.
class DistributedSolver {
 public:
  DistributedSolver(const DistributedMatrices&, double mass_share, double stiffness_share,
                    SolverKind);
  DistributedSolver(const DistributedMatrices& m, Mat only, SolverKind kind);
  ~DistributedSolver();
  DistributedSolver(const DistributedSolver&) = delete;
  /// From x as first guess. \throws RunError if it does not converge.
  void solve(const DistributedVector& b, DistributedVector& x);
  int iterations() const { return iterations_; }

 private:
  void set_up(const DistributedMatrices&, Mat, SolverKind);
  Mat own_ = nullptr;
  KSP ksp_ = nullptr;
  int iterations_ = 0;
};

/// Surface nodes' values to rank 0, their forces from it.
class SurfaceExchange {
 public:
  SurfaceExchange(const DistributedMatrices&, const std::vector<int>& nodes);
  ~SurfaceExchange();
  SurfaceExchange(const SurfaceExchange&) = delete;
  /// On rank 0: a vector per surface node; elsewhere `values` is left alone.
  void gather(const DistributedVector&, std::vector<Vec>& values);
  /// `forces` of rank 0 count; y is overwritten.
  void scatter(const std::vector<Vec>& forces, DistributedVector& y);

 private:
  std::vector<std::array<int, 3>> place_;  // in the list on rank 0, -1 where held
  ::Vec list_ = nullptr;
  VecScatter scatter_ = nullptr;
};

}  // namespace trackbed::fem
