#include "fem/unsymmetric_solver.h"

#include <petscmat.h>

#include "base/error.h"
#include "fem/session.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// What PETSc made, given back in any case.
struct Objects {
  Mat A = nullptr, factor = nullptr;
  ::Vec b = nullptr, x = nullptr;
  IS rows = nullptr, columns = nullptr;
  ~Objects() {
    ISDestroy(&rows), ISDestroy(&columns);
    VecDestroy(&b), VecDestroy(&x);
    MatDestroy(&factor), MatDestroy(&A);
    PetscPopErrorHandler();
  }
};

}  // namespace

void solve_unsymmetric(const Pattern& p, const std::vector<double>& A, const std::vector<double>& b,
                       std::vector<double>& x, const char* what) {
  start_session();
  const int n = p.rows();
  x.resize(n);
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  Objects o;
  const auto check = [&](PetscErrorCode code) {
    if (code)
      throw RunError(text(what, ": the tangent is singular (PETSc error ", static_cast<int>(code),
                          "); the load is probably more than the material bears"));
  };
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, const_cast<int*>(p.start.data()),
                                  const_cast<int*>(p.column.data()), const_cast<double*>(A.data()),
                                  &o.A));
  check(MatGetFactor(o.A, MATSOLVERMUMPS, MAT_FACTOR_LU, &o.factor));
  check(MatGetOrdering(o.A, MATORDERINGND, &o.rows, &o.columns));
  MatFactorInfo info;
  MatFactorInfoInitialize(&info);
  check(MatLUFactorSymbolic(o.factor, o.A, o.rows, o.columns, &info));
  check(MatLUFactorNumeric(o.factor, o.A, &info));
  MatFactorError error = MAT_FACTOR_NOERROR;
  MatFactorGetError(o.factor, &error);
  check(static_cast<PetscErrorCode>(error));
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, b.data(), &o.b));
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, x.data(), &o.x));
  check(MatSolve(o.factor, o.b, o.x));
}

}  // namespace trackbed::fem
