#include "fem/frequencies.h"

#include <slepceps.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/session.h"
#include "fem/sparse.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

Mat matrix(const Pattern& p, const std::vector<double>& values) {
  Mat A = nullptr;
  MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, p.rows(), p.rows(), const_cast<int*>(p.start.data()),
                            const_cast<int*>(p.column.data()), const_cast<double*>(values.data()),
                            &A);
  MatSetOption(A, MAT_SYMMETRIC, PETSC_TRUE);
  return A;
}

std::vector<double> lumped(const Matrices& m) {
  std::vector<double> ones(m.pattern.rows(), 1.), mass;
  multiply(m.pattern, m.mass, ones, mass);
  return mass;
}

::Vec vector(const std::vector<double>& values) {
  ::Vec x = nullptr;
  VecCreateSeqWithArray(PETSC_COMM_SELF, 1, static_cast<PetscInt>(values.size()), values.data(),
                        &x);
  return x;
}

// The rigid motions that cost no energy (ω² below `zero`), M-orthonormal: the six of the free body,
// or what its supports leave of them.
std::vector<std::vector<double>> rigid_modes(const Matrices& m, double zero) {
  const int six = static_cast<int>(m.rigid.size()), n = m.pattern.rows();
  if (six == 0) return {};
  Eigen::MatrixXd K(six, six), M(six, six);
  std::vector<double> x;
  for (int j = 0; j < six; ++j) {
    multiply(m.pattern, m.stiffness, m.rigid[j], x);
    for (int i = 0; i < six; ++i) K(i, j) = dot(m.rigid[i], x);
    multiply(m.pattern, m.mass, m.rigid[j], x);
    for (int i = 0; i < six; ++i) M(i, j) = dot(m.rigid[i], x);
  }
  // A motion that supports hold altogether has no mass.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> of_mass((M + M.transpose()) / 2);
  Eigen::MatrixXd basis(six, 0);
  for (int k = 0; k < six; ++k) {
    if (!(of_mass.eigenvalues()[k] > 1e-12 * of_mass.eigenvalues()[six - 1])) continue;
    basis.conservativeResize(six, basis.cols() + 1);
    basis.rightCols(1) = of_mass.eigenvectors().col(k) / std::sqrt(of_mass.eigenvalues()[k]);
  }
  const Eigen::MatrixXd reduced = basis.transpose() * (K + K.transpose()) / 2 * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(reduced);
  std::vector<std::vector<double>> modes;
  for (int k = 0; k < basis.cols() && solver.eigenvalues()[k] < zero; ++k) {
    const Eigen::VectorXd share = basis * solver.eigenvectors().col(k);
    modes.emplace_back(n, 0.);
    for (int j = 0; j < six; ++j)
      for (int i = 0; i < n; ++i) modes.back()[i] += share[j] * m.rigid[j][i];
  }
  return modes;
}

// Makes the last shape M-orthonormal to those before it: the nearly singular factor leaves 1e-7 of
// the rigid motions in it.
void orthonormalise_last(const Matrices& m, std::vector<std::vector<double>>& shape) {
  std::vector<double>& last = shape.back();
  std::vector<double> x;
  multiply(m.pattern, m.mass, last, x);
  for (std::size_t k = 0; k + 1 < shape.size(); ++k) {
    const double share = dot(shape[k], x);
    for (std::size_t i = 0; i < last.size(); ++i) last[i] -= share * shape[k][i];
  }
  multiply(m.pattern, m.mass, last, x);
  const double size = std::sqrt(dot(last, x));
  for (double& value : last) value /= size;
}

}  // namespace

double largest_frequency(const Matrices& m) {
  const int n = m.pattern.rows();
  const std::vector<double> mass = lumped(m);
  std::vector<double> x(n), y;
  for (int i = 0; i < n; ++i)
    x[i] = std::sin(1. + 7.13 * i) / std::sqrt(mass[i]);  // any start, always the same
  double value = 0;
  for (int step = 0; step < 500; ++step) {
    multiply(m.pattern, m.stiffness, x, y);
    double xx = 0, xy = 0;
    for (int i = 0; i < n; ++i) {
      xx += x[i] * mass[i] * x[i];
      xy += x[i] * y[i];
      y[i] /= mass[i];
    }
    const double now = xy / xx, scale = 1 / std::sqrt(xx);
    for (int i = 0; i < n; ++i) x[i] = y[i] * scale;
    double size = 0;
    for (int i = 0; i < n; ++i) size += x[i] * mass[i] * x[i];
    size = std::sqrt(size);
    if (!(size > 0)) break;
    for (int i = 0; i < n; ++i) x[i] /= size;
    if (std::abs(now - value) < 1e-6 * now && step > 20) {
      value = now;
      break;
    }
    value = now;
  }
  return 1.02 * std::sqrt(std::max(value, 0.));
}

std::vector<double> lowest_frequencies(const Matrices& m, int count) {
  return lowest_modes(m, count).frequency;
}

Modes lowest_modes(const Matrices& m, int count) {
  start_session();
  const int n = m.pattern.rows();
  if (count < 1 || count > n)
    throw InputError(text(count, " frequencies asked for, allowed are 1 to ", n));
  // A shift below the lowest elastic frequencies: a tiny share of the largest.
  const double omega = largest_frequency(m), shift = -1e-9 * omega * omega;
  Modes modes;
  modes.shape = rigid_modes(m, 1e-12 * omega * omega);
  if (static_cast<int>(modes.shape.size()) > count) modes.shape.resize(count);
  const int rigid = static_cast<int>(modes.shape.size());
  modes.frequency.assign(rigid, 0.);
  count -= rigid;
  if (count == 0) return modes;

  Mat K = matrix(m.pattern, m.stiffness), M = matrix(m.pattern, m.mass);
  EPS eps = nullptr;
  EPSCreate(PETSC_COMM_SELF, &eps);
  EPSSetOperators(eps, K, M);
  EPSSetProblemType(eps, EPS_GHEP);
  EPSSetDimensions(eps, count, std::min(n, 2 * count + 20), PETSC_DEFAULT);
  EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE);
  EPSSetTarget(eps, shift);
  EPSSetTolerances(eps, 1e-10, 500);
  std::vector<::Vec> known;  // a Krylov space sees one vector of a sixfold frequency
  for (const auto& shape : modes.shape) known.push_back(vector(shape));
  if (rigid > 0) EPSSetDeflationSpace(eps, rigid, known.data());
  ST st = nullptr;
  KSP ksp = nullptr;
  PC pc = nullptr;
  EPSGetST(eps, &st);
  STSetType(st, STSINVERT);
  STGetKSP(st, &ksp);
  KSPSetType(ksp, KSPPREONLY);
  KSPGetPC(ksp, &pc);
  PCSetType(pc, PCCHOLESKY);
  PCFactorSetMatSolverType(pc, MATSOLVERMUMPS);
  const PetscErrorCode code = EPSSolve(eps);
  PetscInt found = 0;
  if (!code) EPSGetConverged(eps, &found);
  std::vector<std::pair<double, PetscInt>> order;
  for (PetscInt i = 0; i < std::min<PetscInt>(found, count); ++i) {
    PetscScalar value = 0;
    EPSGetEigenvalue(eps, i, &value, nullptr);
    order.emplace_back(std::sqrt(std::max(value, 0.)) / (2 * M_PI), i);
  }
  std::sort(order.begin(), order.end());
  ::Vec x = nullptr;
  MatCreateVecs(K, &x, nullptr);
  for (const auto& [frequency, i] : order) {
    EPSGetEigenvector(eps, i, x, nullptr);
    const PetscScalar* values = nullptr;
    VecGetArrayRead(x, &values);
    modes.frequency.push_back(frequency);
    modes.shape.emplace_back(values, values + n);
    VecRestoreArrayRead(x, &values);
    orthonormalise_last(m, modes.shape);
  }
  VecDestroy(&x);
  for (::Vec& v : known) VecDestroy(&v);
  EPSDestroy(&eps);
  MatDestroy(&K);
  MatDestroy(&M);
  if (static_cast<int>(order.size()) < count)
    throw RunError(text("natural frequencies: only ", found, " of ", count, " converged"));
  return modes;
}

}  // namespace trackbed::fem
