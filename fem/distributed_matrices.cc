#include "fem/distributed_matrices.h"

#include <deal.II/distributed/tria.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "fem/element.h"
#include "fem/mesh.h"
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

// Which rank owns each cell, by p4est.
std::vector<int> partition(const Grid& grid) {
  dealii::parallel::distributed::Triangulation<3> forest(MPI_COMM_WORLD);
  forest.copy_triangulation(grid.cells);
  std::vector<int> owner(grid.cells.n_active_cells(), -1);
  for (const auto& cell : forest.active_cell_iterators())
    if (cell->is_locally_owned()) owner[cell->index()] = rank();
  MPI_Allreduce(MPI_IN_PLACE, owner.data(), static_cast<int>(owner.size()), MPI_INT, MPI_MAX,
                MPI_COMM_WORLD);
  return owner;
}

Discretisation make(const ElasticBodyParameters& p, Grid& grid) {
  if (p.order != 1 && p.order != 2)
    throw InputError(text(p.name, ": element order ", p.order, ", allowed are 1 and 2"));
  make_cells(p, grid);
  return discretise(grid);
}

}  // namespace

DistributedMatrices::DistributedMatrices(ElasticBodyParameters given)
    : p(std::move(given)),
      grid(p.order),
      body(make(p, grid)),
      unknowns(number_unknowns(body, p.name, p.supports)),
      gravity_force(new DistributedVector),
      gravity(*gravity_force) {
  held = free_motion(body, unknowns, p.beds).empty();
  lumped = p.mass == Mass::lumped || (p.mass == Mass::automatic && held);
  const std::vector<int> owner_of_cell = partition(grid);
  const int n = body.nodes_per_cell, size = ranks();
  std::vector<int> owner(unknowns.count, size);
  for (std::size_t c = 0; c < owner_of_cell.size(); ++c)
    for (int a = 0; a < n; ++a)
      for (const int id : unknowns.of_node[body.cell_nodes[c * n + a]])
        if (id >= 0) owner[id] = std::min(owner[id], owner_of_cell[c]);
  rows_of_rank.assign(size, 0);
  for (const int r : owner) ++rows_of_rank[r];
  std::vector<int> next(size, 0);
  for (int r = 1; r < size; ++r) next[r] = next[r - 1] + rows_of_rank[r - 1];
  first_row = next[rank()], own_rows = rows_of_rank[rank()];
  row.resize(unknowns.count);
  for (int i = 0; i < unknowns.count; ++i) row[i] = next[owner[i]]++;
  gravity.reinit(*this);
  assemble(owner_of_cell);
}

DistributedMatrices::~DistributedMatrices() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (ended) return;
  MatDestroy(&stiffness);
  MatDestroy(&consistent);
  VecDestroy(&diagonal);
}

void DistributedMatrices::assemble(const std::vector<int>& owner_of_cell) {
  const int n = body.nodes_per_cell, count = unknowns.count;
  // A node's neighbours: 27 nodes, 125 for order 2.
  const int most = std::min(count, p.order == 1 ? 81 : 375);
  const auto make_matrix = [&](Mat& A) {
    check(MatCreateAIJ(MPI_COMM_WORLD, own_rows, own_rows, count, count, std::min(most, own_rows),
                       nullptr, std::min(most, count - own_rows), nullptr, &A),
          p.name.c_str());
    MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE);
    MatSetOption(A, MAT_NEW_NONZERO_ALLOCATION_ERR, PETSC_FALSE);
  };
  make_matrix(stiffness);
  if (!lumped) make_matrix(consistent);
  check(VecCreateMPI(MPI_COMM_WORLD, own_rows, count, &diagonal), p.name.c_str());
  node_mass.assign(body.nodes(), 0.);

  ElementIntegrals element(p, grid);
  std::vector<int> rows(3 * n);
  std::vector<double> K(9 * n * n), M(9 * n * n);
  std::size_t c = 0;
  std::vector<int> columns(3 * n);
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    // Each rank sums the whole of its own rows, over its neighbours' cells too, in the cells'
    // order: parts that came by messages would be added in the order of their arrival.
    bool any = false;
    for (int a = 0; a < n; ++a)
      for (int d = 0; d < 3; ++d) {
        const int id = unknowns.of_node[body.cell_nodes[c * n + a]][d];
        const int at = id < 0 ? -1 : row[id];  // PETSc leaves negative rows and columns out
        const bool own = at >= first_row && at < first_row + own_rows;
        columns[3 * a + d] = at;
        rows[3 * a + d] = own ? at : -1;
        any |= own;
      }
    const bool own_cell = owner_of_cell[c] == rank();
    if (!any && !own_cell) {
      ++c;
      continue;
    }
    element.compute(cell);
    for (int a = 0; a < 3 * n; ++a)
      for (int b = 0; b < 3 * n; ++b) {
        K[3 * n * a + b] = element.stiffness(a, b);
        M[3 * n * a + b] = a % 3 == b % 3 ? element.mass(a / 3, b / 3) : 0.;
      }
    MatSetValues(stiffness, 3 * n, rows.data(), 3 * n, columns.data(), K.data(), ADD_VALUES);
    if (!lumped)
      MatSetValues(consistent, 3 * n, rows.data(), 3 * n, columns.data(), M.data(), ADD_VALUES);
    for (int a = 0; a < n; ++a) {
      double sum = 0;
      for (int b = 0; b < n; ++b) sum += element.mass(a, b);
      if (own_cell) node_mass[body.cell_nodes[c * n + a]] += sum;
      for (int d = 0; d < 3; ++d)
        if (rows[3 * a + d] >= 0) {
          const double weight = sum * p.gravity[d];
          VecSetValue(diagonal, rows[3 * a + d], sum, ADD_VALUES);
          if (weight != 0) VecSetValue(gravity.v, rows[3 * a + d], weight, ADD_VALUES);
        }
    }
    ++c;
  }
  for (Mat A : {stiffness, consistent}) {
    if (!A) continue;
    MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY);
    MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY);
  }
  for (::Vec x : {diagonal, gravity.v}) VecAssemblyBegin(x), VecAssemblyEnd(x);
  MPI_Allreduce(MPI_IN_PLACE, node_mass.data(), static_cast<int>(node_mass.size()), MPI_DOUBLE,
                MPI_SUM, MPI_COMM_WORLD);
}

void DistributedMatrices::multiply_stiffness(const DistributedVector& x,
                                             DistributedVector& y) const {
  MatMult(stiffness, x.v, y.v);
}
void DistributedMatrices::multiply_mass(const DistributedVector& x, DistributedVector& y) const {
  if (lumped)
    VecPointwiseMult(y.v, diagonal, x.v);
  else
    MatMult(consistent, x.v, y.v);
}
void DistributedMatrices::divide_by_mass(DistributedVector& x) const {
  VecPointwiseDivide(x.v, x.v, diagonal);
}
void DistributedMatrices::solve_mass(const DistributedVector& f, DistributedVector& a) const {
  a.copy(f);
  if (lumped)
    divide_by_mass(a);
  else
    DistributedSolver(*this, consistent, SolverKind::direct).solve(f, a);
}
double DistributedMatrices::mass_product(const DistributedVector& x,
                                         DistributedVector& work) const {
  multiply_mass(x, work);
  return work.dot(x);
}
double DistributedMatrices::stiffness_product(const DistributedVector& x,
                                              DistributedVector& work) const {
  multiply_stiffness(x, work);
  return work.dot(x);
}

// Power iteration on the lumped mass; a little more than what it finds.
double DistributedMatrices::largest_frequency() {
  DistributedVector x, y;
  x.reinit(*this), y.reinit(*this);
  std::vector<double> start(unknowns.count);
  for (int i = 0; i < unknowns.count; ++i) start[i] = std::sin(1. + 7.13 * i);
  x.take(*this, start);
  double value = 0;
  for (int k = 0; k < 500; ++k) {
    PetscReal size = 0;
    VecNorm(x.v, NORM_2, &size);
    x.scale(1 / size);
    multiply_stiffness(x, y);
    divide_by_mass(y);
    PetscScalar now = 0;
    VecPointwiseMult(y.v, y.v, diagonal);
    const double strain = y.dot(x);
    divide_by_mass(y);
    DistributedVector mass(x);
    VecPointwiseMult(mass.v, diagonal, x.v);
    now = strain / mass.dot(x);
    x.copy(y);
    if (k > 20 && std::abs(now - value) < 1e-6 * now) {
      value = now;
      break;
    }
    value = now;
  }
  omega = 1.02 * std::sqrt(std::max(value, 0.));
  return omega;
}

double DistributedMatrices::mass() const {
  double sum = 0;
  for (const double m : node_mass) sum += m;
  return sum;
}

double DistributedMatrices::least_mass(const std::vector<int>& nodes) const {
  std::vector<double> mass(body.nodes(), 0.);  // images share a node
  for (int i = 0; i < body.nodes(); ++i) mass[unknowns.same_as[i]] += node_mass[i];
  double least = std::numeric_limits<double>::infinity();
  for (const int node : nodes) {
    const auto& ids = unknowns.of_node[node];
    if (std::max({ids[0], ids[1], ids[2]}) >= 0)
      least = std::min(least, mass[unknowns.same_as[node]]);
  }
  return least;
}

std::vector<Vec> DistributedMatrices::at_nodes(const std::vector<double>& all) const {
  std::vector<Vec> values(body.nodes(), Vec{});
  for (int i = 0; i < body.nodes(); ++i)
    for (int d = 0; d < 3; ++d)
      if (const int id = unknowns.of_node[i][d]; id >= 0) values[i][d] = all[id];
  return values;
}

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

DistributedSolver::DistributedSolver(const DistributedMatrices& m, double mass_share,
                                     double stiffness_share, SolverKind kind) {
  check(MatDuplicate(m.stiffness, MAT_COPY_VALUES, &own_), m.p.name.c_str());
  MatScale(own_, stiffness_share);
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
    std::vector<::Vec> modes;
    for (const auto& motion : rigid_motions(m.body, m.unknowns)) {
      DistributedVector x;
      x.reinit(m);
      x.take(m, motion);
      for (::Vec before : modes) {  // orthonormal, as PETSc wants them
        PetscScalar share = 0;
        VecDot(x.v, before, &share);
        VecAXPY(x.v, -share, before);
      }
      PetscReal size = 0;
      VecNorm(x.v, NORM_2, &size);
      if (!(size > 1e-10)) continue;
      x.scale(1 / size);
      modes.push_back(x.v);
      x.v = nullptr;
    }
    MatNullSpace near = nullptr;
    MatNullSpaceCreate(MPI_COMM_WORLD, PETSC_FALSE, static_cast<int>(modes.size()), modes.data(),
                       &near);
    MatSetNearNullSpace(A, near);
    MatNullSpaceDestroy(&near);
    for (::Vec& x : modes) VecDestroy(&x);
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
