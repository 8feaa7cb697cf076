#include "fem/unsymmetric_solver.h"

#include "base/error.h"
#include "fem/near_null_space.h"
#include "fem/session.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// PETSc's errors come back as codes instead of on the screen.
struct Quiet {
  Quiet() { PetscPushErrorHandler(PetscReturnErrorHandler, nullptr); }
  ~Quiet() { PetscPopErrorHandler(); }
};

struct Objects {
  Mat A = nullptr;
  ::Vec b = nullptr, x = nullptr;
  ~Objects() {
    VecDestroy(&b), VecDestroy(&x);
    MatDestroy(&A);
  }
};

}  // namespace

UnsymmetricSolver::UnsymmetricSolver(Mat A, SolverKind kind, std::string body)
    : body_(std::move(body)) {
  PetscInt unknowns = 0;
  MatGetSize(A, &unknowns, nullptr);
  kind = chosen_solver(kind, unknowns);
  direct_ = kind == SolverKind::direct;
  KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(A)), &ksp_);
  KSPSetOperators(ksp_, A, A);
  PC pc = nullptr;
  KSPGetPC(ksp_, &pc);
  if (direct_) {
    KSPSetType(ksp_, KSPPREONLY);
    PCSetType(pc, PCLU);
    PCFactorSetMatSolverType(pc, MATSOLVERMUMPS);
    return;
  }
  KSPSetType(ksp_, KSPGMRES);
  KSPGMRESSetRestart(ksp_, 200);
  KSPSetPCSide(ksp_, PC_RIGHT);  // the residual that is watched is then the system's own
  KSPSetTolerances(ksp_, 1e-10, 1e-300, PETSC_DEFAULT, 2000);
  if (kind == SolverKind::cg_boomeramg) {
    PCSetType(pc, PCHYPRE);
    PCHYPRESetType(pc, "boomeramg");
  } else {
    PCSetType(pc, PCGAMG);
    PCGAMGSetReuseInterpolation(pc, PETSC_FALSE);  // a resumed run has none to reuse
  }
}

UnsymmetricSolver::~UnsymmetricSolver() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (!ended) KSPDestroy(&ksp_);
}

void UnsymmetricSolver::solve(::Vec b, ::Vec x) {
  const Quiet quiet;
  const PetscErrorCode code = KSPSolve(ksp_, b, x);
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt count = 0;
  KSPGetConvergedReason(ksp_, &reason);
  KSPGetIterationNumber(ksp_, &count);
  iterations_ = direct_ ? 0 : static_cast<int>(count);
  if (!code && reason >= 0) return;
  if (direct_)
    throw RunError(text(body_, ": the tangent is singular (PETSc error ", static_cast<int>(code),
                        ", reason ", static_cast<int>(reason),
                        "); the load is probably more than the material bears"));
  throw RunError(text(body_, ": GMRES on the tangent did not converge in ", count,
                      " iterations (PETSc error ", static_cast<int>(code), ", reason ",
                      static_cast<int>(reason),
                      "); the load is probably more than the material bears, or try Linear solver "
                      "= direct"));
}

void solve_unsymmetric(const Pattern& p, const std::vector<double>& A, const std::vector<double>& b,
                       std::vector<double>& x, const std::string& body, SolverKind kind,
                       const std::vector<std::vector<double>>& rigid) {
  start_session();
  const int n = p.rows();
  x.resize(n);
  Objects o;
  const auto sequential = [&](const std::vector<double>& values) {
    ::Vec v = nullptr;
    VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, values.data(), &v);
    return v;
  };
  MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, const_cast<int*>(p.start.data()),
                            const_cast<int*>(p.column.data()), const_cast<double*>(A.data()), &o.A);
  if (chosen_solver(kind, n) != SolverKind::direct) {
    MatNullSpace near = near_null_space(rigid);
    MatSetNearNullSpace(o.A, near);
    MatNullSpaceDestroy(&near);
  }
  o.b = sequential(b), o.x = sequential(x);
  UnsymmetricSolver(o.A, kind, body).solve(o.b, o.x);
}

}  // namespace trackbed::fem
