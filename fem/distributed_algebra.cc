#include "fem/distributed_algebra.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "fem/near_null_space.h"
#include "fem/session.h"
#include "fem/supports.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

void check(PetscErrorCode code, const char* what) {
  if (code)
    throw RunError(text(what, ": PETSc failed (error ", static_cast<int>(code),
                        "); is the body held, are all materials set?"));
}

}  // namespace

DistributedVector::DistributedVector(const DistributedVector& x) {
  VecDuplicate(x.v, &v);
  VecCopy(x.v, v);
}
DistributedVector::~DistributedVector() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (!ended && v) VecDestroy(&v);
}
void DistributedVector::reinit(const DistributedMatrices& m) {
  VecCreateMPI(MPI_COMM_WORLD, m.own_rows, m.unknowns.count, &v);
  VecSet(v, 0);
}
void DistributedVector::view(const DistributedMatrices& m, std::vector<double>& own) {
  VecCreateMPIWithArray(MPI_COMM_WORLD, 1, m.own_rows, m.unknowns.count, own.data(), &v);
}
void DistributedVector::copy_own(std::vector<double>& to) const {
  const PetscScalar* local = nullptr;
  VecGetArrayRead(v, &local);
  std::copy_n(local, to.size(), to.begin());
  VecRestoreArrayRead(v, &local);
}
double DistributedVector::dot(const DistributedVector& x) const {
  PetscScalar sum = 0;
  VecDot(v, x.v, &sum);
  return sum;
}
void DistributedVector::add(const DistributedMatrices& m, int node, int d, double value) {
  const int id = m.unknowns.of_node[node][d];
  if (id < 0 || m.row[id] < m.first_row || m.row[id] >= m.first_row + m.own_rows) return;
  PetscScalar* local = nullptr;
  VecGetArray(v, &local);
  local[m.row[id] - m.first_row] += value;
  VecRestoreArray(v, &local);
}
double DistributedVector::own(const DistributedMatrices& m, int node, int d) const {
  const int id = m.unknowns.of_node[node][d];
  if (id < 0 || m.row[id] < m.first_row || m.row[id] >= m.first_row + m.own_rows) return 0;
  const PetscScalar* local = nullptr;
  VecGetArrayRead(v, &local);
  const double value = local[m.row[id] - m.first_row];
  VecRestoreArrayRead(v, &local);
  return value;
}
std::vector<double> DistributedVector::everywhere(const DistributedMatrices& m) const {
  std::vector<double> by_row(m.unknowns.count), all(m.unknowns.count);
  std::vector<int> start(m.rows_of_rank.size(), 0);
  for (std::size_t r = 1; r < start.size(); ++r) start[r] = start[r - 1] + m.rows_of_rank[r - 1];
  const PetscScalar* local = nullptr;
  VecGetArrayRead(v, &local);
  MPI_Allgatherv(local, m.own_rows, MPI_DOUBLE, by_row.data(), m.rows_of_rank.data(), start.data(),
                 MPI_DOUBLE, MPI_COMM_WORLD);
  VecRestoreArrayRead(v, &local);
  for (int i = 0; i < m.unknowns.count; ++i) all[i] = by_row[m.row[i]];
  return all;
}
void DistributedVector::take(const DistributedMatrices& m, const std::vector<double>& all) {
  PetscScalar* local = nullptr;
  VecGetArray(v, &local);
  for (int i = 0; i < m.unknowns.count; ++i)
    if (m.row[i] >= m.first_row && m.row[i] < m.first_row + m.own_rows)
      local[m.row[i] - m.first_row] = all[i];
  VecRestoreArray(v, &local);
}

void set_rigid_motions(const DistributedMatrices& m, Mat A) {
  std::vector<::Vec> motions;
  for (const auto& motion : rigid_motions(m.body, m.unknowns)) {
    DistributedVector x;
    x.reinit(m);
    x.take(m, motion);
    motions.push_back(x.v);
    x.v = nullptr;
  }
  MatNullSpace near = near_null_space(MPI_COMM_WORLD, motions);
  MatSetNearNullSpace(A, near);
  MatNullSpaceDestroy(&near);
}

DistributedSolver::DistributedSolver(const DistributedMatrices& m, double mass_share,
                                     double damping_share, double stiffness_share,
                                     SolverKind kind) {
  check(MatDuplicate(m.stiffness, MAT_COPY_VALUES, &own_), m.p.name.c_str());
  MatScale(own_, stiffness_share);
  if (m.damped) MatAXPY(own_, damping_share, m.damping, SAME_NONZERO_PATTERN);
  if (m.lumped) {
    ::Vec scaled = nullptr;
    VecDuplicate(m.diagonal, &scaled);
    VecCopy(m.diagonal, scaled);
    VecScale(scaled, mass_share);
    MatDiagonalSet(own_, scaled, ADD_VALUES);
    VecDestroy(&scaled);
  } else {
    MatAXPY(own_, mass_share, m.consistent, SAME_NONZERO_PATTERN);
  }
  set_up(m, own_, kind);
}

DistributedSolver::DistributedSolver(const DistributedMatrices& m, Mat only, SolverKind kind) {
  set_up(m, only, kind);
}

void DistributedSolver::set_up(const DistributedMatrices& m, Mat A, SolverKind kind) {
  MatSetOption(A, MAT_SPD, PETSC_TRUE);
  check(KSPCreate(MPI_COMM_WORLD, &ksp_), m.p.name.c_str());
  KSPSetOperators(ksp_, A, A);
  PC pc = nullptr;
  KSPGetPC(ksp_, &pc);
  if (chosen_solver(kind, m.unknowns.count) == SolverKind::direct) {
    KSPSetType(ksp_, KSPPREONLY);
    PCSetType(pc, PCCHOLESKY);
    PCFactorSetMatSolverType(pc, MATSOLVERMUMPS);
  } else {
    set_rigid_motions(m, A);
    KSPSetType(ksp_, KSPCG);
    KSPSetInitialGuessNonzero(ksp_, PETSC_TRUE);
    KSPSetTolerances(ksp_, 1e-10, 1e-300, PETSC_DEFAULT, 2000);
    if (kind == SolverKind::cg_boomeramg) {
      PCSetType(pc, PCHYPRE);
      PCHYPRESetType(pc, "boomeramg");
    } else {
      PCSetType(pc, PCGAMG);
    }
  }
  check(KSPSetUp(ksp_), m.p.name.c_str());
}

DistributedSolver::~DistributedSolver() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (ended) return;
  KSPDestroy(&ksp_);
  MatDestroy(&own_);
}

void DistributedSolver::solve(const DistributedVector& b, DistributedVector& x) {
  check(KSPSolve(ksp_, b.v, x.v), "linear solve");
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  KSPGetConvergedReason(ksp_, &reason);
  PetscInt count = 0;
  KSPGetIterationNumber(ksp_, &count);
  PC pc = nullptr;
  KSPGetPC(ksp_, &pc);
  KSPType type = nullptr;
  KSPGetType(ksp_, &type);
  iterations_ = std::string(type) == KSPPREONLY ? 0 : static_cast<int>(count);
  if (reason < 0)
    throw RunError(text("linear solve: no convergence after ", count, " iterations (PETSc reason ",
                        static_cast<int>(reason), ")"));
}

SurfaceExchange::SurfaceExchange(const DistributedMatrices& m, const std::vector<int>& nodes) {
  std::vector<PetscInt> rows;  // each once: images share an unknown
  std::vector<int> seen(m.unknowns.count, -1);
  for (const int node : nodes) {
    std::array<int, 3> at{-1, -1, -1};
    for (int d = 0; d < 3; ++d)
      if (const int id = m.unknowns.of_node[node][d]; id >= 0) {
        if (seen[id] < 0) {
          seen[id] = static_cast<int>(rows.size());
          rows.push_back(m.row[id]);
        }
        at[d] = seen[id];
      }
    place_.push_back(at);
  }
  const PetscInt count = rank() == 0 ? static_cast<PetscInt>(rows.size()) : 0;
  IS from = nullptr;
  ISCreateGeneral(PETSC_COMM_SELF, count, rows.data(), PETSC_COPY_VALUES, &from);
  VecCreateSeq(PETSC_COMM_SELF, count, &list_);
  VecScatterCreate(m.gravity.v, from, list_, nullptr, &scatter_);
  ISDestroy(&from);
}

SurfaceExchange::~SurfaceExchange() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (ended) return;
  VecDestroy(&list_);
  VecScatterDestroy(&scatter_);
}

void SurfaceExchange::gather(const DistributedVector& x, std::vector<Vec>& values) {
  VecScatterBegin(scatter_, x.v, list_, INSERT_VALUES, SCATTER_FORWARD);
  VecScatterEnd(scatter_, x.v, list_, INSERT_VALUES, SCATTER_FORWARD);
  if (rank() != 0) return;
  const PetscScalar* list = nullptr;
  VecGetArrayRead(list_, &list);
  values.assign(place_.size(), Vec{});
  for (std::size_t i = 0; i < place_.size(); ++i)
    for (int d = 0; d < 3; ++d)
      if (place_[i][d] >= 0) values[i][d] = list[place_[i][d]];
  VecRestoreArrayRead(list_, &list);
}

void SurfaceExchange::scatter(const std::vector<Vec>& forces, DistributedVector& y) {
  VecSet(list_, 0);
  PetscScalar* list = nullptr;
  VecGetArray(list_, &list);
  if (rank() == 0)
    for (std::size_t i = 0; i < forces.size(); ++i)
      for (int d = 0; d < 3; ++d)
        if (place_[i][d] >= 0) list[place_[i][d]] += forces[i][d];
  VecRestoreArray(list_, &list);
  VecSet(y.v, 0);
  VecScatterBegin(scatter_, list_, y.v, ADD_VALUES, SCATTER_REVERSE);
  VecScatterEnd(scatter_, list_, y.v, ADD_VALUES, SCATTER_REVERSE);
}

}  // namespace trackbed::fem
