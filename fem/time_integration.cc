#include "fem/time_integration.h"

#include <cmath>

#include "base/error.h"
#include "fem/frequencies.h"
#include "fem/text.h"

namespace trackbed::fem {

Scheme newmark() { return {0, 0, 0.25, 0.5}; }

Scheme generalised_alpha(double r) {
  if (!(r >= 0 && r <= 1)) throw InputError(text("rho_inf = ", r, ": allowed are 0 to 1"));
  const double am = (2 * r - 1) / (r + 1), af = r / (r + 1);
  return {am, af, 0.25 * (1 - am + af) * (1 - am + af), 0.5 - am + af};
}

Stepper::Stepper(const Matrices& matrices, Scheme scheme) : matrices_(matrices), scheme_(scheme) {
  const int n = matrices.pattern.rows();
  for (auto* work : {&m_, &k_, &rhs_, &next_}) work->assign(n, 0.);
  if (!matrices.damping.empty()) c_.assign(n, 0.);
  if (!matrices.lumped.empty() && matrices.damping.empty())
    explicit_limit_ = 0.9 * 2 / largest_frequency(matrices);
}

void Stepper::set_step(double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    throw InputError(text("time step of the structure: ", dt, " s given, must be positive"));
  dt_ = dt;
  explicit_ = dt <= explicit_limit_;
  if (explicit_) return;
  auto found = factors_.find(dt);
  if (found == factors_.end()) {
    const auto& [alpha_m, alpha_f, beta, gamma] = scheme_;
    std::vector<double> values(matrices_.mass.size());
    const double m = 1 - alpha_m, c = (1 - alpha_f) * gamma * dt,
                 k = (1 - alpha_f) * beta * dt * dt;
    for (std::size_t e = 0; e < values.size(); ++e)
      values[e] = m * matrices_.mass[e] + k * matrices_.stiffness[e];
    if (!matrices_.damping.empty())
      for (std::size_t e = 0; e < values.size(); ++e) values[e] += c * matrices_.damping[e];
    found = factors_.emplace(dt, Factor(matrices_.pattern, values, "structure's step")).first;
  }
  factor_ = &found->second;
}

void Stepper::advance(Motion& s, const std::vector<double>& force) {
  if (!(dt_ > 0)) throw RunError("structure: set_step() must come before advance()");
  if (explicit_)
    advance_explicitly(s, force);
  else
    advance_implicitly(s, force);
}

void Stepper::advance_explicitly(Motion& s, const std::vector<double>& force) {
  const double dt = dt_;
  const std::size_t n = s.u.size();
  for (std::size_t i = 0; i < n; ++i) s.u[i] += dt * (s.v[i] + 0.5 * dt * s.a[i]);
  multiply(matrices_.pattern, matrices_.stiffness, s.u, rhs_);
  for (std::size_t i = 0; i < n; ++i) {
    const double a = (force[i] - rhs_[i]) / matrices_.lumped[i];
    s.v[i] += 0.5 * dt * (s.a[i] + a);
    s.a[i] = a;
    s.f[i] = force[i];
  }
}

void Stepper::advance_implicitly(Motion& s, const std::vector<double>& force) {
  const auto& [alpha_m, alpha_f, beta, gamma] = scheme_;
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
  factor_->solve(rhs_, next_);
  for (std::size_t i = 0; i < n; ++i) {
    s.u[i] += dt * (s.v[i] + dt * ((0.5 - beta) * s.a[i] + beta * next_[i]));
    s.v[i] += dt * ((1 - gamma) * s.a[i] + gamma * next_[i]);
    s.a[i] = next_[i];
    s.f[i] = force[i];
  }
}

void Stepper::set_acceleration(Motion& s) const {
  std::vector<double> rhs = s.f, product;
  multiply(matrices_.pattern, matrices_.stiffness, s.u, product);
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] -= product[i];
  if (!matrices_.damping.empty()) {
    multiply(matrices_.pattern, matrices_.damping, s.v, product);
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] -= product[i];
  }
  Factor(matrices_.pattern, matrices_.mass, "mass matrix").solve(rhs, s.a);
}

}  // namespace trackbed::fem
