// One solve with a matrix that need not be symmetric (a non-associated material's tangent).
#pragma once
#include <vector>

#include "fem/sparse.h"

namespace trackbed::fem {

/// x = A⁻¹ b by PETSc's interface to MUMPS (LU). \throws RunError naming `what` if A is singular.
void solve_unsymmetric(const Pattern&, const std::vector<double>& A, const std::vector<double>& b,
                       std::vector<double>& x, const char* what);

}  // namespace trackbed::fem
