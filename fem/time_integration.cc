#include "fem/time_integration.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/frequencies.h"
#include "fem/text.h"

namespace trackbed::fem {

std::vector<std::string> time_scheme_names() {
  return {"automatic", "newmark", "generalised_alpha", "central_difference", "zhai", "static"};
}

TimeScheme time_scheme_of(const std::string& name) {
  const auto names = time_scheme_names();  // in the order of the enumeration
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  return static_cast<TimeScheme>(at % static_cast<long>(names.size()));
}

Scheme newmark() { return {0, 0, 0.25, 0.5}; }

Scheme generalised_alpha(double r) {
  if (!(r >= 0 && r <= 1)) throw InputError(text("rho_inf = ", r, ": allowed are 0 to 1"));
  const double am = (2 * r - 1) / (r + 1), af = r / (r + 1);
  return {am, af, 0.25 * (1 - am + af) * (1 - am + af), 0.5 - am + af};
}

Scheme zhai(double phi, double psi) { return {0, 0, 0, 0, TimeScheme::zhai, phi, psi}; }

Scheme make_scheme(TimeScheme kind, Scheme implicit) {
  if (kind == TimeScheme::newmark) implicit = newmark();
  if (kind == TimeScheme::zhai) return zhai(0.5, 0.5);
  implicit.kind = kind;
  return implicit;
}

namespace {

// Largest 2ξω of C against the lumped mass, by power iteration, 2 % safe.
double largest_damping(const Matrices& m) {
  if (m.damping.empty()) return 0;
  return std::pow(largest_frequency({m.pattern, m.damping, m.mass}), 2);
}

}  // namespace

double stable_step(TimeScheme scheme, double omega, double damping) {
  const double xi = damping / (2 * omega);
  if (scheme == TimeScheme::zhai) return (2 * std::sqrt(1 + 4 * xi * xi) - 4 * xi) / omega;
  return 2 / omega * (std::sqrt(1 + xi * xi) - xi);
}

Stepper::Stepper(const Matrices& matrices, Scheme scheme, SolverKind kind)
    : matrices_(matrices), scheme_(scheme), kind_(kind) {
  const int n = matrices.pattern.rows();
  for (auto* work : {&m_, &k_, &rhs_, &next_}) work->assign(n, 0.);
  if (!matrices.damping.empty()) c_.assign(n, 0.);
  if (scheme.kind == TimeScheme::central_difference || scheme.kind == TimeScheme::zhai) {
    if (matrices.lumped.empty())
      throw InputError("central_difference and zhai need a body with lumped mass");
    largest_step_ =
        stable_step(scheme.kind, largest_frequency(matrices), largest_damping(matrices));
  } else if (scheme.kind == TimeScheme::automatic && !matrices.lumped.empty() &&
             matrices.damping.empty()) {
    explicit_limit_ = 0.9 * 2 / largest_frequency(matrices);
  }
}

void Stepper::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  if (dt > largest_step_)
    throw InputError(text("time step of the structure: ", dt, " s is over the limit ",
                          largest_step_,
                          " s of its explicit scheme; take a smaller one, a coarser "
                          "mesh or an implicit scheme"));
  dt_ = dt;
  explicit_ = dt <= explicit_limit_ || std::isfinite(largest_step_);
  if (explicit_) return;
  auto found = solvers_.find(dt);
  if (found == solvers_.end()) {
    const auto& [alpha_m, alpha_f, beta, gamma, name, phi, psi] = scheme_;
    std::vector<double> values = matrices_.stiffness;
    if (name != TimeScheme::quasi_static) {
      const double m = 1 - alpha_m, c = (1 - alpha_f) * gamma * dt,
                   k = (1 - alpha_f) * beta * dt * dt;
      for (std::size_t e = 0; e < values.size(); ++e)
        values[e] = m * matrices_.mass[e] + k * matrices_.stiffness[e];
      if (!matrices_.damping.empty())
        for (std::size_t e = 0; e < values.size(); ++e) values[e] += c * matrices_.damping[e];
    }
    found = solvers_
                .emplace(dt, LinearSolver(matrices_.pattern, values, "structure's step", kind_,
                                          matrices_.rigid))
                .first;
  }
  solver_ = &found->second;
}

void Stepper::advance(Motion& s, const std::vector<double>& force) {
  if (!(dt_ > 0)) throw RunError("structure: set_step() must come before advance()");
  if (scheme_.kind == TimeScheme::zhai)
    advance_zhai(s, force);
  else if (scheme_.kind == TimeScheme::quasi_static)
    advance_statically(s, force);
  else if (explicit_)
    advance_explicitly(s, force);
  else
    advance_implicitly(s, force);
}

void Stepper::advance_zhai(Motion& s, const std::vector<double>& force) {
  const double dt = dt_, phi = scheme_.phi, psi = scheme_.psi;
  const std::size_t n = s.u.size();
  if (s.a_before.empty()) s.a_before = s.a;
  for (std::size_t i = 0; i < n; ++i) {
    s.u[i] += dt * (s.v[i] + dt * ((0.5 + psi) * s.a[i] - psi * s.a_before[i]));
    s.v[i] += dt * ((1 + phi) * s.a[i] - phi * s.a_before[i]);
  }
  s.a_before = s.a;
  s.f = force;
  accelerate(s);
}

void Stepper::advance_statically(Motion& s, const std::vector<double>& force) {
  next_ = s.u;
  solver_->solve(force, next_);
  for (std::size_t i = 0; i < s.u.size(); ++i) {
    s.v[i] = (next_[i] - s.u[i]) / dt_;
    s.u[i] = next_[i];
  }
  s.f = force;
}

// a = M⁻¹ (f − C v − K u) with the lumped mass.
void Stepper::accelerate(Motion& s) {
  multiply(matrices_.pattern, matrices_.stiffness, s.u, rhs_);
  if (!c_.empty()) multiply(matrices_.pattern, matrices_.damping, s.v, c_);
  for (std::size_t i = 0; i < s.u.size(); ++i)
    s.a[i] = (s.f[i] - rhs_[i] - (c_.empty() ? 0 : c_[i])) / matrices_.lumped[i];
}

void Stepper::advance_explicitly(Motion& s, const std::vector<double>& force) {
  const double dt = dt_;
  const std::size_t n = s.u.size();
  for (std::size_t i = 0; i < n; ++i) {
    s.v[i] += 0.5 * dt * s.a[i];  // half a step on
    s.u[i] += dt * s.v[i];
  }
  s.f = force;
  accelerate(s);
  for (std::size_t i = 0; i < n; ++i) s.v[i] += 0.5 * dt * s.a[i];
}

void Stepper::advance_implicitly(Motion& s, const std::vector<double>& force) {
  const auto& [alpha_m, alpha_f, beta, gamma, name, phi, psi] = scheme_;
  const std::size_t n = s.u.size();
  const double w = 1 - alpha_f, dt = dt_;
  for (std::size_t i = 0; i < n; ++i) {
    m_[i] = alpha_m * s.a[i];
    k_[i] = s.u[i] + w * dt * (s.v[i] + dt * (0.5 - beta) * s.a[i]);
    rhs_[i] = w * force[i] + alpha_f * s.f[i];
  }
  subtract_products(matrices_.pattern, matrices_.mass, m_, matrices_.stiffness, k_, rhs_);
  if (!c_.empty()) {
    for (std::size_t i = 0; i < n; ++i) c_[i] = s.v[i] + w * dt * (1 - gamma) * s.a[i];
    multiply(matrices_.pattern, matrices_.damping, c_, next_);
    for (std::size_t i = 0; i < n; ++i) rhs_[i] -= next_[i];
  }
  next_ = s.a;  // where it starts, if it iterates: after a resume too
  solver_->solve(rhs_, next_);
  for (std::size_t i = 0; i < n; ++i) {
    s.u[i] += dt * (s.v[i] + dt * ((0.5 - beta) * s.a[i] + beta * next_[i]));
    s.v[i] += dt * ((1 - gamma) * s.a[i] + gamma * next_[i]);
    s.a[i] = next_[i];
    s.f[i] = force[i];
  }
}

void Stepper::set_acceleration(Motion& s) const {
  s.a_before.clear();
  if (scheme_.kind == TimeScheme::quasi_static) return s.a.assign(s.u.size(), 0.);
  std::vector<double> rhs = s.f, product;
  multiply(matrices_.pattern, matrices_.stiffness, s.u, product);
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] -= product[i];
  if (!matrices_.damping.empty()) {
    multiply(matrices_.pattern, matrices_.damping, s.v, product);
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] -= product[i];
  }
  if (matrices_.lumped.empty())
    return LinearSolver(matrices_.pattern, matrices_.mass, "mass matrix", kind_).solve(rhs, s.a);
  for (std::size_t i = 0; i < rhs.size(); ++i) s.a[i] = rhs[i] / matrices_.lumped[i];
}

}  // namespace trackbed::fem
