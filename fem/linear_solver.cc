#include "fem/linear_solver.h"

#include <petscmat.h>

#include "base/error.h"
#include "fem/session.h"
#include "fem/text.h"

namespace trackbed::fem {

struct Factor::Petsc {
  Mat factor = nullptr;
  ::Vec b = nullptr, x = nullptr;
  ~Petsc() {
    PetscBool ended = PETSC_FALSE;
    PetscFinalized(&ended);
    if (ended) return;
    VecDestroy(&b);
    VecDestroy(&x);
    MatDestroy(&factor);
  }
};

namespace {

void check(PetscErrorCode code, const char* what) {
  if (code)
    throw RunError(
        text(what, ": PETSc could not factorise or solve (error ", static_cast<int>(code),
             "); the matrix is probably singular: is the body held, are all materials set?"));
}

}  // namespace

Factor::Factor(const Pattern& p, const std::vector<double>& values, const char* what)
    : petsc_(new Petsc) {
  start_session();
  const int n = p.rows();
  // Symmetric storage: the upper triangle, diagonal first in each row.
  std::vector<PetscInt> rows(n + 1, 0), columns;
  std::vector<PetscScalar> upper;
  columns.reserve(p.column.size() / 2 + n);
  upper.reserve(p.column.size() / 2 + n);
  for (int r = 0; r < n; ++r) {
    for (int e = p.start[r]; e < p.start[r + 1]; ++e)
      if (p.column[e] >= r) {
        columns.push_back(p.column[e]);
        upper.push_back(values[e]);
      }
    rows[r + 1] = static_cast<PetscInt>(columns.size());
  }
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  struct Restore {
    ~Restore() { PetscPopErrorHandler(); }
  } restore;
  Mat A = nullptr;
  check(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, n, n, rows.data(), columns.data(),
                                    upper.data(), &A),
        what);
  struct Release {
    Mat& A;
    ~Release() { MatDestroy(&A); }
  } release{A};
  MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE);
  MatSetOption(A, MAT_SPD, PETSC_TRUE);
  check(MatGetFactor(A, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &petsc_->factor), what);
  MatFactorInfo info;
  MatFactorInfoInitialize(&info);
  info.fill = 10;
  IS order = nullptr, unused = nullptr;
  check(MatGetOrdering(A, MATORDERINGND, &order, &unused), what);
  PetscErrorCode code = MatCholeskyFactorSymbolic(petsc_->factor, A, order, &info);
  if (!code) code = MatCholeskyFactorNumeric(petsc_->factor, A, &info);
  ISDestroy(&order);
  ISDestroy(&unused);
  check(code, what);
  MatFactorError error = MAT_FACTOR_NOERROR;
  MatFactorGetError(petsc_->factor, &error);
  check(static_cast<PetscErrorCode>(error), what);
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, nullptr, &petsc_->b), what);
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, nullptr, &petsc_->x), what);
}

Factor::~Factor() = default;
Factor::Factor(Factor&&) noexcept = default;

void Factor::solve(const std::vector<double>& b, std::vector<double>& x) const {
  VecPlaceArray(petsc_->b, b.data());
  VecPlaceArray(petsc_->x, x.data());
  const PetscErrorCode code = MatSolve(petsc_->factor, petsc_->b, petsc_->x);
  VecResetArray(petsc_->b);
  VecResetArray(petsc_->x);
  check(code, "linear solve");
}

}  // namespace trackbed::fem
