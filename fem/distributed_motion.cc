#include "fem/distributed_motion.h"

#include <cmath>

#include "base/error.h"

namespace trackbed::fem {
namespace {

class LinearMotion final : public DistributedMotion {
 public:
  explicit LinearMotion(const DistributedMatrices&);

  bool is_static() const override { return scheme_.kind == TimeScheme::quasi_static; }
  bool is_explicit() const override { return explicit_; }
  double explicit_limit() const override { return explicit_limit_; }
  double largest_step() const override { return largest_step_; }
  double largest_frequency() const override { return omega_; }
  double step() const override { return dt_; }
  int iterations() const override { return solver_ ? solver_->iterations() : 0; }
  void set_step(double dt) override;
  void advance(const DistributedVector& force) override;
  void start(bool in_equilibrium) override;
  void predict(DistributedVector& displacement, DistributedVector& velocity) override;
  double kinetic() override { return is_static() ? 0 : m_.mass_product(v, work_) / 2; }
  double strain() override { return m_.stiffness_product(u, work_) / 2; }
  double gravity() override { return -m_.gravity.dot(u); }
  Loss loss(const DistributedVector& moved, DistributedVector& v_before) override;
  std::vector<DistributedVector*> state() override;

 private:
  void advance_statically(const DistributedVector& force);
  void advance_explicitly(const DistributedVector& force);
  void advance_zhai(const DistributedVector& force);
  void advance_implicitly(const DistributedVector& force);
  void accelerate(const DistributedVector& force);

  const DistributedMatrices& m_;
  Scheme scheme_;
  double dt_ = 0, omega_ = 0, explicit_limit_ = 0;
  double largest_step_ = std::numeric_limits<double>::infinity();
  bool explicit_ = false;
  std::unique_ptr<DistributedSolver> solver_;
  DistributedVector a_before_;  // of Zhai: a step earlier
  DistributedVector work_, rhs_;
};

LinearMotion::LinearMotion(const DistributedMatrices& m)
    : m_(m),
      scheme_(make_scheme(m.p.scheme, m.p.newmark ? newmark() : generalised_alpha(m.p.rho_inf))) {
  for (auto* x : {&u, &v, &a, &f, &a_before_, &work_, &rhs_}) x->reinit(m);
  if (is_static() && !m.held)
    throw InputError(m.p.name + ": not held, so that no static answer exists; add supports");
  if (m.lumped) omega_ = m.largest_root(m.stiffness);
  if (scheme_.kind == TimeScheme::central_difference || scheme_.kind == TimeScheme::zhai) {
    const double damping = m.damped ? std::pow(m.largest_root(m.damping), 2) : 0;
    explicit_limit_ = largest_step_ = stable_step(scheme_.kind, omega_, damping);
  } else if (scheme_.kind == TimeScheme::automatic && m.lumped && !m.damped) {
    explicit_limit_ = 0.9 * 2 / omega_;
  }
}

void LinearMotion::set_step(double dt) {
  dt_ = dt;
  if (is_static()) {  // one factor for all steps
    if (!solver_) solver_ = std::make_unique<DistributedSolver>(m_, m_.stiffness, m_.p.solver);
    return;
  }
  explicit_ = dt <= explicit_limit_;
  solver_.reset();
  if (explicit_) return;
  const double w = 1 - scheme_.alpha_f;
  solver_ = std::make_unique<DistributedSolver>(m_, 1 - scheme_.alpha_m, w * scheme_.gamma * dt,
                                                w * scheme_.beta * dt * dt, m_.p.solver);
}

void LinearMotion::advance(const DistributedVector& force) {
  if (is_static())
    advance_statically(force);
  else if (scheme_.kind == TimeScheme::zhai)
    advance_zhai(force);
  else if (explicit_)
    advance_explicitly(force);
  else
    advance_implicitly(force);
  f.copy(force);
}

void LinearMotion::advance_statically(const DistributedVector& force) {
  v.copy(u);
  solver_->solve(force, u);
  v.scale(-1);
  v.add_scaled(1, u);
  v.scale(1 / dt_);
}

// a = M⁻¹ (force − C v − K u) with the lumped mass.
void LinearMotion::accelerate(const DistributedVector& force) {
  m_.multiply_stiffness(u, rhs_);
  a.copy(force);
  a.add_scaled(-1, rhs_);
  if (m_.damped) {
    m_.multiply_damping(v, rhs_);
    a.add_scaled(-1, rhs_);
  }
  m_.divide_by_mass(a);
}

void LinearMotion::advance_explicitly(const DistributedVector& force) {
  u.add_scaled(dt_, v);
  u.add_scaled(0.5 * dt_ * dt_, a);
  v.add_scaled(0.5 * dt_, a);
  accelerate(force);
  v.add_scaled(0.5 * dt_, a);
}

void LinearMotion::advance_zhai(const DistributedVector& force) {
  predict(work_, rhs_);
  u.copy(work_);
  v.add_scaled((1 + scheme_.phi) * dt_, a);
  v.add_scaled(-scheme_.phi * dt_, a_before_);
  a_before_.copy(a);
  accelerate(force);
}

void LinearMotion::advance_implicitly(const DistributedVector& force) {
  const double alpha_m = scheme_.alpha_m, alpha_f = scheme_.alpha_f, beta = scheme_.beta,
               gamma = scheme_.gamma, w = 1 - alpha_f, dt = dt_;
  // rhs = w f₊ + α_f f − α_m M a − C (v + w Δt (1−γ) a) − K (u + w Δt (v + Δt (½−β) a))
  work_.copy(u);
  work_.add_scaled(w * dt, v);
  work_.add_scaled(w * dt * dt * (0.5 - beta), a);
  m_.multiply_stiffness(work_, rhs_);
  rhs_.scale(-1);
  rhs_.add_scaled(w, force);
  rhs_.add_scaled(alpha_f, f);
  m_.multiply_mass(a, work_);
  rhs_.add_scaled(-alpha_m, work_);
  if (m_.damped) {
    DistributedVector product(work_);
    work_.copy(v);
    work_.add_scaled(w * dt * (1 - gamma), a);
    m_.multiply_damping(work_, product);
    rhs_.add_scaled(-1, product);
  }
  work_.copy(a);  // first guess
  solver_->solve(rhs_, work_);
  u.add_scaled(dt, v);
  u.add_scaled(dt * dt * (0.5 - beta), a);
  u.add_scaled(dt * dt * beta, work_);
  v.add_scaled(dt * (1 - gamma), a);
  v.add_scaled(dt * gamma, work_);
  a.copy(work_);
}

void LinearMotion::start(bool in_equilibrium) {
  if (in_equilibrium) {
    DistributedSolver(m_, m_.stiffness, m_.p.solver).solve(f, u);
  } else if (!is_static()) {
    m_.solve_mass(f, a);
    a_before_.copy(a);
  }
}

void LinearMotion::predict(DistributedVector& displacement, DistributedVector& velocity) {
  displacement.copy(u);
  displacement.add_scaled(dt_, v);
  displacement.add_scaled((0.5 + scheme_.psi) * dt_ * dt_, a);
  if (scheme_.psi != 0) displacement.add_scaled(-scheme_.psi * dt_ * dt_, a_before_);
  velocity.copy(v);
  velocity.add_scaled(dt_, a);
}

DistributedMotion::Loss LinearMotion::loss(const DistributedVector& moved,
                                           DistributedVector& mean) {
  Loss loss;
  if (!m_.damped || is_static()) return loss;
  mean.add_scaled(1, v);
  mean.scale(0.5);
  m_.multiply_damping(mean, work_);
  loss.all = moved.dot(work_);
  if (m_.dashpots) {
    MatMult(m_.dashpots, mean.v, work_.v);
    loss.boundary = moved.dot(work_);
  }
  return loss;
}

std::vector<DistributedVector*> LinearMotion::state() {
  std::vector<DistributedVector*> all{&u, &v, &a, &f};
  if (scheme_.kind == TimeScheme::zhai) all.push_back(&a_before_);
  return all;
}

}  // namespace

std::unique_ptr<DistributedMotion> make_linear_motion(const DistributedMatrices& m) {
  return std::make_unique<LinearMotion>(m);
}

}  // namespace trackbed::fem
