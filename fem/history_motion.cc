#include "fem/history_motion.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

constexpr int kMostIterations = 30;
constexpr double kConverged = 1e-10;  // residual over the forces

// Newton's iteration: `residual` gives that of the present guess over the forces, `correct` makes a
// better guess. Returns all residuals.
template <class Residual, class Correct>
std::vector<double> newton(const std::string& body, Residual residual, Correct correct) {
  std::vector<double> found;
  for (;;) {
    found.push_back(residual());
    if (found.back() <= kConverged) return found;
    if (found.size() > kMostIterations || !std::isfinite(found.back()))
      throw RunError(text(
          body, ": Newton's iteration did not converge in ", kMostIterations, " steps (residual ",
          found.back(), " of the forces): more load than the material bears, or too large a step"));
    correct();
  }
}

}  // namespace

HistoryMotion::HistoryMotion(std::string body, const Scheme& scheme, std::vector<double> mass,
                             HistoryCells& cells, HistoryEquations& equations)
    : body_(std::move(body)),
      scheme_(scheme),
      mass_(std::move(mass)),
      cells_(cells),
      equations_(equations) {
  for (auto* field : {&now.u, &now.v, &now.a, &now.f, &inner, &in_situ_, &trial_})
    field->assign(mass_.size(), 0.);
}

void HistoryMotion::start() {
  equations_.evaluate(now.u, true, in_situ_);
  stored = cells_.stored();
  equations_.sum(&stored, 1);
  stored_in_situ_ = stored;
}

void HistoryMotion::set_largest_frequency(double omega) {
  if (!(omega > 0) || !std::isfinite(omega))
    throw InputError(body_ + ": the material's stiffness in situ is not positive and finite");
  limit_ = 0.9 * 2 / omega;
}

void HistoryMotion::find_inner(const std::vector<double>& u, bool want_tangent) {
  equations_.evaluate(u, want_tangent, trial_);
  for (std::size_t i = 0; i < trial_.size(); ++i) trial_[i] -= in_situ_[i];
}

// The last evaluation becomes the state.
void HistoryMotion::commit() {
  inner = trial_;
  cells_.commit();
  double sums[] = {cells_.stored(), cells_.dissipated()};
  equations_.sum(sums, 2);
  stored = sums[0];
  plastic += sums[1];
}

double HistoryMotion::product(const std::vector<double>& x, const std::vector<double>& y) const {
  double value = dot(x, y);
  equations_.sum(&value, 1);
  return value;
}

double HistoryMotion::gravity() const { return -product(in_situ_, now.u); }

double HistoryMotion::kinetic() const {
  double twice = 0;
  for (std::size_t i = 0; i < mass_.size(); ++i) twice += mass_[i] * now.v[i] * now.v[i];
  equations_.sum(&twice, 1);
  return twice / 2;
}

void HistoryMotion::advance(const std::vector<double>& force) {
  if (is_explicit())
    advance_explicitly(force);
  else
    advance_implicitly(force);
  now.f = force;
}

void HistoryMotion::advance_explicitly(const std::vector<double>& force) {
  const int n = static_cast<int>(mass_.size());
  for (int i = 0; i < n; ++i) now.u[i] = place_ahead(i);
  find_inner(now.u, false);
  commit();
  for (int i = 0; i < n; ++i) {
    const double a = (force[i] - inner[i]) / mass_[i];
    now.v[i] += 0.5 * dt_ * (now.a[i] + a);
    now.a[i] = a;
  }
}

void HistoryMotion::advance_implicitly(const std::vector<double>& force) {
  const double alpha_m = scheme_.alpha_m, alpha_f = scheme_.alpha_f, beta = scheme_.beta,
               gamma = scheme_.gamma, w = 1 - alpha_f, dt = dt_;
  const std::size_t n = mass_.size();
  Motion& s = now;
  std::vector<double> a = s.a, u(n), r(n), da(n);
  const auto residual = [&] {
    for (std::size_t i = 0; i < n; ++i)
      u[i] = s.u[i] + dt * (s.v[i] + dt * ((0.5 - beta) * s.a[i] + beta * a[i]));
    find_inner(u, true);
    double sums[] = {0, 0};  // squares of the residual and of the forces
    for (std::size_t i = 0; i < n; ++i) {
      const double outer = w * force[i] + alpha_f * s.f[i],
                   inertia = mass_[i] * ((1 - alpha_m) * a[i] + alpha_m * s.a[i]),
                   stress = w * trial_[i] + alpha_f * inner[i];
      r[i] = outer - inertia - stress;
      sums[0] += r[i] * r[i];
      sums[1] += outer * outer + inertia * inertia + stress * stress;
    }
    equations_.sum(sums, 2);
    return sums[1] == 0 ? 0 : std::sqrt(sums[0] / sums[1]);
  };
  newton(body_, residual, [&] {
    equations_.solve(1 - alpha_m, w * beta * dt * dt, r, da);
    for (std::size_t i = 0; i < n; ++i) a[i] += da[i];
  });
  for (std::size_t i = 0; i < n; ++i) {
    s.v[i] += dt * ((1 - gamma) * s.a[i] + gamma * a[i]);
    s.u[i] = u[i];
    s.a[i] = a[i];
  }
  commit();
}

std::vector<double> HistoryMotion::settle(const std::vector<double>& start,
                                          const std::vector<double>& end, int load_steps) {
  const std::size_t n = mass_.size();
  const double largest = std::sqrt(std::max(product(start, start), product(end, end)));
  std::vector<double> f(n), r(n), du(n), residuals;
  for (int step = 1; step <= load_steps; ++step) {
    const double share = static_cast<double>(step) / load_steps;
    for (std::size_t i = 0; i < n; ++i) f[i] = start[i] + share * (end[i] - start[i]);
    double size = -1;  // of the forces
    const auto residual = [&] {
      find_inner(now.u, true);
      for (std::size_t i = 0; i < n; ++i) r[i] = f[i] - trial_[i];
      if (size < 0) size = std::max(largest, std::sqrt(product(trial_, trial_)));
      return size == 0 ? 0 : std::sqrt(product(r, r)) / size;
    };
    residuals = newton(body_, residual, [&] {
      equations_.solve(0, 1, r, du);
      for (std::size_t i = 0; i < n; ++i) now.u[i] += du[i];
    });
    commit();
  }
  std::fill(now.v.begin(), now.v.end(), 0.);
  std::fill(now.a.begin(), now.a.end(), 0.);
  now.f = end;
  plastic = 0;
  return residuals;
}

}  // namespace trackbed::fem
