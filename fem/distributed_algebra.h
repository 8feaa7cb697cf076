// What a body shared by ranks calculates with: vectors over its unknowns, solves, and the surface's
// values on rank 0. Internal: PETSc.
#pragma once
#include "fem/distributed_matrices.h"

namespace trackbed::fem {

/// A PETSc vector over the unknowns.
class DistributedVector {
 public:
  DistributedVector() = default;
  DistributedVector(const DistributedVector&);
  DistributedVector(DistributedVector&& other) noexcept : v(other.v) { other.v = nullptr; }
  DistributedVector& operator=(const DistributedVector&) = delete;
  ~DistributedVector();
  void reinit(const DistributedMatrices&);
  /// Of the same memory as this rank's values, by row, which must stay where they are.
  void view(const DistributedMatrices&, std::vector<double>& own);
  void copy_own(std::vector<double>& to) const;  ///< this rank's values
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

/// Tells multigrid the rigid motions of a matrix over the unknowns.
void set_rigid_motions(const DistributedMatrices&, Mat);

/// (mass_share M + damping_share C + stiffness_share K) x = b, set up once: MUMPS or conjugate
/// gradients with multigrid.
class DistributedSolver {
 public:
  DistributedSolver(const DistributedMatrices&, double mass_share, double damping_share,
                    double stiffness_share, SolverKind);
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
