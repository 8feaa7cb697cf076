// The motion of a body whose stress has a history, in time and at rest:
//
//   M a + f_int(u, history) − f_int(0, 0) = f,   f_int = ∫Bᵀσ dV,   M lumped
//
// Velocity Verlet without a solve where Δt ≤ 0.9·2/ω_max of the elastic body, else generalised-α or
// Newmark with Newton's iteration on the consistent tangent. The body may be shared by ranks: each
// has some of the unknowns and the cells at them, and all take every step together.
#pragma once
#include <string>
#include <vector>

#include "fem/history_cells.h"
#include "fem/time_integration.h"

namespace trackbed::fem {

/// What the motion asks of its body. Arrays: this rank's unknowns.
class HistoryEquations {
 public:
  virtual ~HistoryEquations() = default;
  /// force = f_int at u, by the cells' evaluate(), and the tangent ∂f_int/∂u if wanted.
  virtual void evaluate(const std::vector<double>& u, bool want_tangent,
                        std::vector<double>& force) = 0;
  /// (mass_share M + tangent_share ∂f_int/∂u) x = b with the last tangent, which it may use up.
  /// \throws RunError if it cannot be solved.
  virtual void solve(double mass_share, double tangent_share, const std::vector<double>& b,
                     std::vector<double>& x) = 0;
  /// Each value's sum over the ranks.
  virtual void sum(double* /*values*/, int /*count*/) const {}
};

class HistoryMotion {
 public:
  /// `body` for messages; `mass`: the diagonal of M. Cells and equations must outlive it.
  HistoryMotion(std::string body, const Scheme&, std::vector<double> mass, HistoryCells&,
                HistoryEquations&);
  HistoryMotion(const HistoryMotion&) = delete;

  /// At rest in situ; the last tangent is then the elastic body's.
  void start();
  /// Of the elastic body [rad/s]. \throws InputError if it is none.
  void set_largest_frequency(double omega);
  double explicit_limit() const { return limit_; }

  void set_step(double dt) { dt_ = dt; }
  double step() const { return dt_; }
  bool is_explicit() const { return dt_ <= limit_; }

  /// u + Δt v + ½Δt² a and v + Δt a of unknown i: where it goes, if explicit.
  double place_ahead(int i) const { return now.u[i] + dt_ * (now.v[i] + 0.5 * dt_ * now.a[i]); }
  double velocity_ahead(int i) const { return now.v[i] + dt_ * now.a[i]; }

  /// From t to t+Δt under the outer force at t+Δt. \throws RunError when Newton's iteration does not
  /// converge; the state is then that of t.
  void advance(const std::vector<double>& force);

  /// To rest under `end`, raised from `start` in equal steps; plastic work counts from there.
  /// Returns the residuals of the last step's iterations over the forces. \throws RunError.
  std::vector<double> settle(const std::vector<double>& start, const std::vector<double>& end,
                             int load_steps);

  double kinetic() const;  ///< [J], of all ranks
  double strain() const { return stored - stored_in_situ_; }
  double gravity() const;

  // The state, besides the cells' history. The arrays stay where they are in memory.
  Motion now;
  std::vector<double> inner;       ///< f_int(u) − f_int(0, 0) at t
  double stored = 0, plastic = 0;  ///< elastic energy, in situ included, and plastic work [J]

 private:
  void find_inner(const std::vector<double>& u, bool want_tangent);
  void commit();
  void advance_explicitly(const std::vector<double>& force);
  void advance_implicitly(const std::vector<double>& force);
  double product(const std::vector<double>&, const std::vector<double>&) const;

  std::string body_;
  Scheme scheme_;
  std::vector<double> mass_;
  HistoryCells& cells_;
  HistoryEquations& equations_;
  double dt_ = 0, limit_ = 0, stored_in_situ_ = 0;
  std::vector<double> in_situ_;  // f_int(0, 0)
  std::vector<double> trial_;    // f_int − f_int(0, 0) of the last evaluation
};

}  // namespace trackbed::fem
