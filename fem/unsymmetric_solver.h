// Solves with a matrix that need not be symmetric: a non-associated material's tangent. Internal:
// PETSc.
#pragma once
#include <petscksp.h>

#include <string>
#include <vector>

#include "fem/linear_solver.h"
#include "fem/sparse.h"

namespace trackbed::fem {

/// By the names of SolverKind: direct is MUMPS (LU), the others are GMRES with GAMG or BoomerAMG,
/// for conjugate gradients need symmetry. On one process or shared, as the matrix is.
class UnsymmetricSolver {
 public:
  /// The matrix must outlive it; its values may change from solve to solve. `body` for messages.
  UnsymmetricSolver(Mat, SolverKind, std::string body);
  ~UnsymmetricSolver();
  UnsymmetricSolver(const UnsymmetricSolver&) = delete;
  /// x = A⁻¹ b. \throws RunError if A is singular or the iteration does not converge.
  void solve(::Vec b, ::Vec x);
  int iterations() const { return iterations_; }  ///< of the last solve; 0 if direct

 private:
  std::string body_;
  KSP ksp_ = nullptr;
  bool direct_;
  int iterations_ = 0;
};

/// x = A⁻¹ b, once, on one process. `rigid`: rigid motions, for multigrid. \throws RunError as above.
void solve_unsymmetric(const Pattern&, const std::vector<double>& A, const std::vector<double>& b,
                       std::vector<double>& x, const std::string& body, SolverKind,
                       const std::vector<std::vector<double>>& rigid);

}  // namespace trackbed::fem
