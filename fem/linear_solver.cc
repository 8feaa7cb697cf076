#include "fem/linear_solver.h"

#include <petscksp.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/near_null_space.h"
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

// --- by name ---

struct LinearSolver::Krylov {
  // The matrix borrows these arrays.
  std::vector<PetscInt> start, column;
  std::vector<PetscScalar> value;
  Mat A = nullptr;
  KSP ksp = nullptr;
  ::Vec b = nullptr, x = nullptr;
  ~Krylov() {
    PetscBool ended = PETSC_FALSE;
    PetscFinalized(&ended);
    if (ended) return;
    KSPDestroy(&ksp);
    VecDestroy(&b);
    VecDestroy(&x);
    MatDestroy(&A);
  }
};

namespace {

constexpr int kLargestDirect = 60000;  // unknowns

}  // namespace

std::vector<std::string> solver_names() {
  return {"automatic", "direct", "cg_gamg", "cg_boomeramg"};
}

SolverKind solver_of(const std::string& name) {
  const auto names = solver_names();  // in the order of the enumeration
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  return static_cast<SolverKind>(at % static_cast<long>(names.size()));
}

SolverKind chosen_solver(SolverKind kind, int unknowns) {
  if (kind != SolverKind::automatic) return kind;
  return unknowns <= kLargestDirect ? SolverKind::direct : SolverKind::cg_gamg;
}

LinearSolver::LinearSolver(const Pattern& p, const std::vector<double>& values, const char* what,
                           SolverKind kind, const std::vector<std::vector<double>>& rigid) {
  start_session();
  const int n = p.rows();
  kind = chosen_solver(kind, n);
  if (kind == SolverKind::direct) {
    factor_ = std::make_unique<Factor>(p, values, what);
    return;
  }
  krylov_ = std::make_unique<Krylov>();
  Krylov& k = *krylov_;
  k.start.assign(p.start.begin(), p.start.end());
  k.column.assign(p.column.begin(), p.column.end());
  k.value.assign(values.begin(), values.end());
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  struct Restore {
    ~Restore() { PetscPopErrorHandler(); }
  } restore;
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, k.start.data(), k.column.data(),
                                  k.value.data(), &k.A),
        what);
  MatSetOption(k.A, MAT_SYMMETRIC, PETSC_TRUE);
  MatSetOption(k.A, MAT_SPD, PETSC_TRUE);
  if (!rigid.empty()) {
    MatNullSpace space = near_null_space(rigid);
    MatSetNearNullSpace(k.A, space);
    MatNullSpaceDestroy(&space);
  }
  check(KSPCreate(PETSC_COMM_SELF, &k.ksp), what);
  KSPSetOperators(k.ksp, k.A, k.A);
  KSPSetType(k.ksp, KSPCG);
  KSPSetNormType(k.ksp, KSP_NORM_UNPRECONDITIONED);
  KSPSetTolerances(k.ksp, 1e-10, 1e-300, 1e10, 1000);
  KSPSetInitialGuessNonzero(k.ksp, PETSC_TRUE);
  PC pc = nullptr;
  KSPGetPC(k.ksp, &pc);
  if (kind == SolverKind::cg_gamg) {
    PCSetType(pc, PCGAMG);
  } else {
    check(PCSetType(pc, PCHYPRE), what);
    check(PCHYPRESetType(pc, "boomeramg"), what);
  }
  check(KSPSetUp(k.ksp), what);
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, nullptr, &k.b), what);
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, nullptr, &k.x), what);
}

LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;

void LinearSolver::solve(const std::vector<double>& b, std::vector<double>& x) const {
  x.resize(b.size());
  if (factor_) return factor_->solve(b, x);
  Krylov& k = *krylov_;
  VecPlaceArray(k.b, b.data());
  VecPlaceArray(k.x, x.data());
  const PetscErrorCode code = KSPSolve(k.ksp, k.b, k.x);
  VecResetArray(k.b);
  VecResetArray(k.x);
  check(code, "linear solve");
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  KSPGetConvergedReason(k.ksp, &reason);
  PetscInt count = 0;
  KSPGetIterationNumber(k.ksp, &count);
  iterations_ = static_cast<int>(count);
  if (reason < 0)
    throw RunError(text("linear solve: conjugate gradients did not converge in ", iterations_,
                        " iterations (PETSc reason ", static_cast<int>(reason),
                        "); try the direct solver"));
}

}  // namespace trackbed::fem
