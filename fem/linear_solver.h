// Direct factor of a symmetric positive definite matrix, through PETSc; kept and used for many
// right-hand sides. Serial and in a fixed order: the same input gives the same bits.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fem/sparse.h"

namespace trackbed::fem {

/// How linear systems are solved.
enum class SolverKind : std::uint8_t { automatic, direct, cg_gamg, cg_boomeramg };

/// By name, and the names there are.
SolverKind solver_of(const std::string& name);
std::vector<std::string> solver_names();

class Factor {
 public:
  /// \throws RunError if the matrix is singular or not positive definite (`what` names it in the
  /// text).
  Factor(const Pattern&, const std::vector<double>& values, const char* what);
  ~Factor();
  Factor(Factor&&) noexcept;

  /// x = A⁻¹ b; no allocation.
  void solve(const std::vector<double>& b, std::vector<double>& x) const;

 private:
  struct Petsc;
  std::unique_ptr<Petsc> petsc_;
};

/// A symmetric positive definite matrix made ready to be solved with many right-hand sides, by
/// name:
///   direct        MUMPS, as Factor: exact, memory grows as n^(4/3)
///   cg_gamg       conjugate gradients with PETSc's smoothed aggregation multigrid
///   cg_boomeramg  conjugate gradients with hypre's BoomerAMG (nodal coarsening by unknowns of one
///                 matrix; slower set-up, sturdier on jumps of stiffness)
///   automatic     direct up to 60 000 unknowns, else cg_gamg
/// Matrix and preconditioner are set up once. The multigrid methods are told the rigid motions, for
/// what they cannot represent on coarse levels converges slowly. Iterations start from the last
/// answer only if `x` holds it and end at ‖r‖ ≤ 1e-10 ‖b‖; one process, fixed order: same bits.
class LinearSolver {
 public:
  /// `rigid`: rigid motions as values of the unknowns, empty if not known.
  /// \throws RunError if the set-up fails.
  LinearSolver(const Pattern&, const std::vector<double>& values, const char* what, SolverKind,
               const std::vector<std::vector<double>>& rigid = {});
  ~LinearSolver();
  LinearSolver(LinearSolver&&) noexcept;

  /// x = A⁻¹ b from x as first guess. \throws RunError if it does not converge.
  void solve(const std::vector<double>& b, std::vector<double>& x) const;

  /// Of the last solve; 0 for direct.
  int iterations() const { return iterations_; }

 private:
  struct Krylov;
  std::unique_ptr<Factor> factor_;
  std::unique_ptr<Krylov> krylov_;
  mutable int iterations_ = 0;
};

/// What automatic means for this many unknowns.
SolverKind chosen_solver(SolverKind, int unknowns);

}  // namespace trackbed::fem
