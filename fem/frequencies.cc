#include "fem/frequencies.h"

#include <slepceps.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/session.h"
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
  Mat K = matrix(m.pattern, m.stiffness), M = matrix(m.pattern, m.mass);
  EPS eps = nullptr;
  EPSCreate(PETSC_COMM_SELF, &eps);
  EPSSetOperators(eps, K, M);
  EPSSetProblemType(eps, EPS_GHEP);
  EPSSetDimensions(eps, count, std::min(n, 2 * count + 20), PETSC_DEFAULT);
  EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE);
  EPSSetTarget(eps, shift);
  EPSSetTolerances(eps, 1e-10, 500);
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
  Modes modes;
  ::Vec x = nullptr;
  MatCreateVecs(K, &x, nullptr);
  for (const auto& [frequency, i] : order) {
    EPSGetEigenvector(eps, i, x, nullptr);
    const PetscScalar* values = nullptr;
    VecGetArrayRead(x, &values);
    modes.frequency.push_back(frequency);
    modes.shape.emplace_back(values, values + n);
    VecRestoreArrayRead(x, &values);
  }
  VecDestroy(&x);
  EPSDestroy(&eps);
  MatDestroy(&K);
  MatDestroy(&M);
  if (static_cast<int>(order.size()) < count)
    throw RunError(text("natural frequencies: only ", found, " of ", count, " converged"));
  return modes;
}

}  // namespace trackbed::fem
