// A body whose stress has a history, shared by ranks. A rank has its own unknowns, and the cells
// that touch them or that p4est gave it: a layer of its neighbours' cells too, with their history.
// So each internal force is summed whole and in the order of the cells where its unknown lives: no
// forces cross between ranks, only displacements, and steps without a solve give the same bits on
// any number of ranks.
#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "base/error.h"
#include "fem/distributed_motion.h"
#include "fem/history_motion.h"
#include "fem/session.h"
#include "fem/unsymmetric_solver.h"

namespace trackbed::fem {
namespace {

// What a rank calculates with: its cells, and where their unknowns are in its arrays, own rows
// first, then those of other ranks that they touch.
struct Share {
  std::vector<int> cells, place;
  std::vector<char> own;      // of the cells
  std::vector<PetscInt> row;  // of each place
};

Share share_of_rank(const DistributedMatrices& m) {
  Share s;
  for (int row = 0; row < m.own_rows; ++row) s.row.push_back(m.first_row + row);
  std::vector<int> place_of(m.unknowns.count, -1);
  for (int id = 0; id < m.unknowns.count; ++id)
    if (const int row = m.own_row(id); row >= 0) place_of[id] = row - m.first_row;
  const auto here = [&](int id) { return id >= 0 && m.own_row(id) >= 0; };
  for (int c = 0; c < static_cast<int>(m.owner_of_cell.size()); ++c) {
    const std::vector<int> ids = cell_unknowns(m.body, m.unknowns, {c});
    const bool own = m.owner_of_cell[c] == rank();
    if (!own && std::none_of(ids.begin(), ids.end(), here)) continue;
    s.cells.push_back(c);
    s.own.push_back(own ? 1 : 0);
    for (const int id : ids) {
      if (id >= 0 && place_of[id] < 0) {
        place_of[id] = static_cast<int>(s.row.size());
        s.row.push_back(m.row[id]);
      }
      s.place.push_back(id < 0 ? -1 : place_of[id]);
    }
  }
  return s;
}

class SharedHistory final : public DistributedMotion, private HistoryEquations {
 public:
  SharedHistory(const DistributedMatrices& m, std::shared_ptr<const StressModel> model)
      : SharedHistory(m, std::move(model), share_of_rank(m)) {}
  ~SharedHistory() override;

  bool is_explicit() const override { return motion_.is_explicit(); }
  double explicit_limit() const override { return motion_.explicit_limit(); }
  double largest_frequency() const override { return 0.9 * 2 / explicit_limit(); }
  double step() const override { return motion_.step(); }
  int iterations() const override { return solver_ ? solver_->iterations() : 0; }
  std::vector<int> rank_cells() const override { return rank_cells_; }
  void set_step(double dt) override { motion_.set_step(dt); }
  void advance(const DistributedVector& force) override {
    force.copy_own(force_);
    motion_.advance(force_);
  }
  void start(bool) override {}  // at rest in situ
  void predict(DistributedVector& displacement, DistributedVector& velocity) override;
  double kinetic() override { return motion_.kinetic(); }
  double strain() override { return motion_.strain(); }
  double gravity() override { return motion_.gravity(); }
  double plastic() const override { return motion_.plastic; }
  std::vector<DistributedVector*> state() override { return {&u, &v, &a, &f, &inner_}; }
  std::size_t more_state_size() const override { return 2 + history_of_body(); }
  std::vector<double> more_state() override;
  void take_more_state(const double*) override;
  std::vector<Voigt> cell_stress() override;

 private:
  SharedHistory(const DistributedMatrices&, std::shared_ptr<const StressModel>, Share);
  void evaluate(const std::vector<double>& u, bool want_tangent,
                std::vector<double>& force) override;
  void solve(double mass_share, double tangent_share, const std::vector<double>& b,
             std::vector<double>& x) override;
  void sum(double* values, int count) const override {
    MPI_Allreduce(MPI_IN_PLACE, values, count, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  }
  std::size_t history_of_body() const { return m_.owner_of_cell.size() * cells_.history_of_cell(); }
  void fetch(const std::vector<double>& own);
  void add_to_tangent(const int* place, const std::vector<double>& K);

  const DistributedMatrices& m_;
  std::vector<PetscInt> row_;  // of each place
  std::vector<double> place_;  // displacements: own rows, then others
  DistributedVector own_;      // the first of them
  ::Vec others_ = nullptr;     // the rest
  VecScatter fetch_ = nullptr;
  HistoryCells cells_;
  HistoryMotion motion_;
  DistributedVector inner_;  // of motion_
  Mat tangent_ = nullptr;
  std::unique_ptr<UnsymmetricSolver> solver_;
  DistributedVector b_, x_;
  std::vector<double> force_, b_own_, x_own_;
  std::vector<PetscInt> rows_, columns_;  // of one cell
  std::vector<int> rank_cells_;
};

// On rank 0: values of which each is known to one rank, and 0 elsewhere; bit by bit, for −0 + 0 is 0.
void join_on_first(double* values, std::size_t count) {
  static_assert(sizeof(double) == sizeof(std::uint64_t));
  MPI_Reduce(rank() == 0 ? MPI_IN_PLACE : values, values, static_cast<int>(count), MPI_UINT64_T,
             MPI_BOR, 0, MPI_COMM_WORLD);
}

std::vector<double> own_mass(const DistributedMatrices& m) {
  std::vector<double> mass(m.own_rows);
  const PetscScalar* local = nullptr;
  VecGetArrayRead(m.diagonal, &local);
  std::copy_n(local, mass.size(), mass.begin());
  VecRestoreArrayRead(m.diagonal, &local);
  return mass;
}

SharedHistory::SharedHistory(const DistributedMatrices& m, std::shared_ptr<const StressModel> model,
                             Share share)
    : m_(m),
      row_(std::move(share.row)),
      place_(row_.size(), 0.),
      cells_(m.grid, m.p.order, std::move(model), std::move(share.cells), std::move(share.place),
             std::move(share.own)),
      motion_(m.p.name, m.p.newmark ? newmark() : generalised_alpha(m.p.rho_inf), own_mass(m),
              cells_, *this) {
  const auto others = static_cast<PetscInt>(row_.size()) - m.own_rows;
  own_.view(m, place_);
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, others, place_.data() + m.own_rows, &others_);
  IS from = nullptr;
  ISCreateGeneral(PETSC_COMM_SELF, others, row_.data() + m.own_rows, PETSC_COPY_VALUES, &from);
  VecScatterCreate(own_.v, from, others_, nullptr, &fetch_);
  ISDestroy(&from);

  Motion& now = motion_.now;
  u.view(m, now.u), v.view(m, now.v), a.view(m, now.a), f.view(m, now.f);
  inner_.view(m, motion_.inner);
  for (auto* x : {&force_, &b_own_, &x_own_}) x->assign(m.own_rows, 0.);
  b_.view(m, b_own_), x_.view(m, x_own_);

  MatDuplicate(m.stiffness, MAT_DO_NOT_COPY_VALUES, &tangent_);
  MatSetOption(tangent_, MAT_SYMMETRIC, PETSC_FALSE);
  MatSetOption(tangent_, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE);
  if (chosen_solver(m.p.solver, m.unknowns.count) != SolverKind::direct)
    set_rigid_motions(m, tangent_);
  const int count = static_cast<int>(cells_.cells().size());
  rank_cells_.resize(ranks());
  MPI_Allgather(&count, 1, MPI_INT, rank_cells_.data(), 1, MPI_INT, MPI_COMM_WORLD);
  motion_.start();
  motion_.set_largest_frequency(m.largest_root(tangent_));
}

SharedHistory::~SharedHistory() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (ended) return;
  VecScatterDestroy(&fetch_);
  VecDestroy(&others_);
  MatDestroy(&tangent_);
}

void SharedHistory::predict(DistributedVector& displacement, DistributedVector& velocity) {
  PetscScalar *to_u = nullptr, *to_v = nullptr;
  VecGetArray(displacement.v, &to_u);
  VecGetArray(velocity.v, &to_v);
  for (int i = 0; i < m_.own_rows; ++i) {
    to_u[i] = motion_.place_ahead(i);
    to_v[i] = motion_.velocity_ahead(i);
  }
  VecRestoreArray(displacement.v, &to_u);
  VecRestoreArray(velocity.v, &to_v);
}

// place_ at the displacements `own` of all ranks.
void SharedHistory::fetch(const std::vector<double>& own) {
  std::copy(own.begin(), own.end(), place_.begin());
  VecScatterBegin(fetch_, own_.v, others_, INSERT_VALUES, SCATTER_FORWARD);
  VecScatterEnd(fetch_, own_.v, others_, INSERT_VALUES, SCATTER_FORWARD);
}

void SharedHistory::evaluate(const std::vector<double>& at, bool want_tangent,
                             std::vector<double>& force) {
  fetch(at);
  std::fill(force.begin(), force.end(), 0.);
  try {
    if (!want_tangent) return cells_.evaluate(place_, force, nullptr);
    MatZeroEntries(tangent_);
    cells_.evaluate(place_, force, [&](const int* place, const std::vector<double>& K) {
      add_to_tangent(place, K);
    });
  } catch (const std::exception& e) {
    // A model's own error on one rank: the others would wait for it for ever.
    std::fprintf(stderr, "trackbed: %s\n", e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MatAssemblyBegin(tangent_, MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(tangent_, MAT_FINAL_ASSEMBLY);
}

void SharedHistory::add_to_tangent(const int* place, const std::vector<double>& K) {
  const int n = 3 * m_.body.nodes_per_cell;
  rows_.assign(n, -1), columns_.assign(n, -1);  // PETSc leaves negative ones out
  for (int j = 0; j < n; ++j) {
    if (place[j] < 0) continue;
    columns_[j] = row_[place[j]];
    if (place[j] < m_.own_rows) rows_[j] = columns_[j];
  }
  MatSetValues(tangent_, n, rows_.data(), n, columns_.data(), K.data(), ADD_VALUES);
}

void SharedHistory::solve(double mass_share, double tangent_share, const std::vector<double>& b,
                          std::vector<double>& x) {
  MatScale(tangent_, tangent_share);
  DistributedVector mass;
  mass.reinit(m_);
  VecAXPY(mass.v, mass_share, m_.diagonal);
  MatDiagonalSet(tangent_, mass.v, ADD_VALUES);
  if (!solver_) solver_ = std::make_unique<UnsymmetricSolver>(tangent_, m_.p.solver, m_.p.name);
  b_own_ = b;
  solver_->solve(b_.v, x_.v);
  x = x_own_;
}

std::vector<double> SharedHistory::more_state() {
  const std::size_t size = cells_.history_of_cell();
  std::vector<double> all(history_of_body(), 0.);
  for (std::size_t k = 0; k < cells_.cells().size(); ++k)
    if (cells_.own(static_cast<int>(k)))
      std::copy_n(cells_.history().data() + k * size, size, all.data() + cells_.cells()[k] * size);
  join_on_first(all.data(), all.size());
  all.insert(all.begin(), {motion_.stored, motion_.plastic});
  return all;
}

void SharedHistory::take_more_state(const double* from) {
  motion_.stored = from[0], motion_.plastic = from[1];
  const std::size_t size = cells_.history_of_cell();
  for (std::size_t k = 0; k < cells_.cells().size(); ++k)
    std::copy_n(from + 2 + cells_.cells()[k] * size, size, cells_.history().data() + k * size);
}

std::vector<Voigt> SharedHistory::cell_stress() {
  fetch(motion_.now.u);
  const std::vector<Voigt> mean = cells_.mean_stress(place_);
  std::vector<Voigt> all(m_.owner_of_cell.size(), Voigt{});
  for (std::size_t k = 0; k < mean.size(); ++k)
    if (cells_.own(static_cast<int>(k))) all[cells_.cells()[k]] = mean[k];
  join_on_first(all.data()->data(), 6 * all.size());
  return all;
}

}  // namespace

std::unique_ptr<DistributedMotion> make_history_motion(const DistributedMatrices& m,
                                                       std::shared_ptr<const StressModel> model) {
  return std::make_unique<SharedHistory>(m, std::move(model));
}

}  // namespace trackbed::fem
