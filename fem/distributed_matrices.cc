#include "fem/distributed_matrices.h"

#include <deal.II/distributed/tria.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "fem/bed_integrals.h"
#include "fem/body_model.h"
#include "fem/distributed_algebra.h"
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
  lumped = lumped_mass(p, body, unknowns);
  damped = damps(p);
  owner_of_cell = partition(grid);
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
  assemble();
}

DistributedMatrices::~DistributedMatrices() {
  PetscBool ended = PETSC_FALSE;
  PetscFinalized(&ended);
  if (ended) return;
  MatDestroy(&stiffness);
  MatDestroy(&consistent);
  MatDestroy(&damping);
  MatDestroy(&dashpots);
  VecDestroy(&diagonal);
}

void DistributedMatrices::assemble() {
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
  if (damped) make_matrix(damping);
  if (has_dashpots(p)) make_matrix(dashpots);
  check(VecCreateMPI(MPI_COMM_WORLD, own_rows, count, &diagonal), p.name.c_str());
  node_mass.assign(body.nodes(), 0.);

  ElementIntegrals element(p, grid);
  std::vector<int> rows(3 * n);
  std::vector<double> K(9 * n * n), M(9 * n * n), C(9 * n * n);
  std::vector<std::array<double, 3>> elastic(owner_of_cell.size());  // E, ν, ρ
  std::size_t c = 0;
  std::vector<int> columns(3 * n);
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    // Each rank sums the whole of its own rows, over its neighbours' cells too, in the cells'
    // order: parts that came by messages would be added in the order of their arrival.
    bool any = false;
    for (int a = 0; a < n; ++a)
      for (int d = 0; d < 3; ++d) {
        const int id = unknowns.of_node[body.cell_nodes[c * n + a]][d];
        columns[3 * a + d] = id < 0 ? -1 : row[id];  // PETSc leaves negative ones out
        rows[3 * a + d] = own_row(id);
        any |= rows[3 * a + d] >= 0;
      }
    const bool own_cell = owner_of_cell[c] == rank();
    if (!any && !own_cell) {
      element.pass(cell);
      ++c;
      continue;
    }
    element.compute(cell);
    elastic[c] = element.mean_elastic();
    const Material& material = p.materials[cell->material_id()];
    for (int a = 0; a < 3 * n; ++a)
      for (int b = 0; b < 3 * n; ++b) {
        K[3 * n * a + b] = element.stiffness(a, b);
        M[3 * n * a + b] = a % 3 == b % 3 ? element.mass(a / 3, b / 3) : 0.;
      }
    if (damped) {
      for (int a = 0; a < 3 * n; ++a) {
        double sum = 0;  // of the mass's row
        for (int b = 0; b < 3 * n; ++b) sum += M[3 * n * a + b];
        for (int b = 0; b < 3 * n; ++b) {
          const double mass = lumped ? (a == b ? sum : 0) : M[3 * n * a + b];
          C[3 * n * a + b] =
              material.rayleigh_mass * mass + material.rayleigh_stiffness * K[3 * n * a + b];
        }
      }
      MatSetValues(damping, 3 * n, rows.data(), 3 * n, columns.data(), C.data(), ADD_VALUES);
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
  add_beds(elastic);
  for (Mat A : {stiffness, consistent, damping, dashpots}) {
    if (!A) continue;
    MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY);
    MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY);
  }
  for (::Vec x : {diagonal, gravity.v}) VecAssemblyBegin(x), VecAssemblyEnd(x);
  MPI_Allreduce(MPI_IN_PLACE, node_mass.data(), static_cast<int>(node_mass.size()), MPI_DOUBLE,
                MPI_SUM, MPI_COMM_WORLD);
}

int DistributedMatrices::own_row(int unknown) const {
  const int at = unknown < 0 ? -1 : row[unknown];
  return at >= first_row && at < first_row + own_rows ? at : -1;
}

// Each rank its own rows, as in assemble(): it knows `elastic` of the cells that have any.
void DistributedMatrices::add_beds(const std::vector<std::array<double, 3>>& elastic) {
  for (const Bed& bed : p.beds) {
    const int boundary = check_bed(p, bed, body);
    for (const Face& face : body.faces) {
      if (face.boundary != boundary) continue;
      std::vector<int> rows, columns;
      for (int i = 0; i < face.count; ++i)
        for (const int id : unknowns.of_node[face.nodes[i]]) {
          columns.push_back(id < 0 ? -1 : row[id]);
          rows.push_back(own_row(id));
        }
      if (*std::max_element(rows.begin(), rows.end()) < 0) continue;
      const FaceSprings springs = face_springs(bed, body, face, elastic[face.cell]);
      const int n = 3 * face.count;
      const auto add = [&](Mat A, const std::vector<double>& values) {
        MatSetValues(A, n, rows.data(), n, columns.data(), values.data(), ADD_VALUES);
      };
      add(stiffness, springs.stiffness);
      if (!dashpots) continue;
      add(damping, springs.dashpot);
      add(dashpots, springs.dashpot);
    }
  }
}

void DistributedMatrices::multiply_damping(const DistributedVector& x, DistributedVector& y) const {
  MatMult(damping, x.v, y.v);
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

// Power iteration on the lumped mass.
double DistributedMatrices::largest_root(Mat A) const {
  DistributedVector x, y, mx;
  for (auto* v : {&x, &y, &mx}) v->reinit(*this);
  std::vector<double> start(unknowns.count);
  for (int i = 0; i < unknowns.count; ++i) start[i] = std::sin(1. + 7.13 * i);
  x.take(*this, start);
  double value = 0;
  for (int k = 0; k < 500; ++k) {
    PetscReal size = 0;
    VecNorm(x.v, NORM_2, &size);
    if (!(size > 0)) break;
    x.scale(1 / size);
    MatMult(A, x.v, y.v);
    VecPointwiseMult(mx.v, diagonal, x.v);
    const double now = y.dot(x) / mx.dot(x);
    divide_by_mass(y);
    x.copy(y);
    const bool settled = k > 20 && std::abs(now - value) < 1e-6 * now;
    value = now;
    if (settled) break;
  }
  return 1.02 * std::sqrt(std::max(value, 0.));
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

}  // namespace trackbed::fem
