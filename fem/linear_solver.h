// Direct factor of a symmetric positive definite matrix, through PETSc; kept and used for many
// right-hand sides. Serial and in a fixed order: the same input gives the same bits.
#pragma once
#include <memory>
#include <vector>

#include "fem/sparse.h"

namespace trackbed::fem {

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

}  // namespace trackbed::fem
