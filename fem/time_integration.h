// Time integration of M a + C v + K u = f with constant matrices.
//
// Implicit, one solve a step (generalised-α of Chung and Hulbert 1993, Newmark's average
// acceleration as a special case); matrix and preconditioner are kept per step size:
//   (1−α_m) M a₊ + α_m M a + (1−α_f)(C v₊ + K u₊) + α_f (C v + K u) = (1−α_f) f₊ + α_f f
//   u₊ = u + Δt v + Δt² ((½−β) a + β a₊),   v₊ = v + Δt ((1−γ) a + γ a₊)
// Explicit, with lumped mass, no solve:
//   central difference (velocity Verlet), dampers at the velocity half a step before:
//     v½ = v + ½Δt a,  u₊ = u + Δt v½,  a₊ = M⁻¹(f₊ − C v½ − K u₊),  v₊ = v½ + ½Δt a₊
//     stable for Δt ≤ 2/ω (√(1+ξ²) − ξ)
//   Zhai 1996 (Int. J. Numer. Meth. Eng. 39:4199), φ = ψ = ½:
//     u₊ = u + Δt v + (½+ψ)Δt² a − ψΔt² a₋,  v₊ = v + (1+φ)Δt a − φΔt a₋,
//     a₊ = M⁻¹(f₊ − C v₊ − K u₊)
//     stable for ωΔt ≤ 2 √(1+4ξ²) − 4ξ (from the root −1 of its characteristic polynomial)
// Quasi-static: K u₊ = f₊, v₊ = (u₊ − u)/Δt, a = 0.
#pragma once
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "fem/linear_solver.h"
#include "fem/sparse.h"

namespace trackbed::fem {

struct Matrices {
  Pattern pattern;
  std::vector<double> stiffness, mass;
  std::vector<double> damping = {};  ///< empty: none; dashpots of the boundary are part of it
  std::vector<double> lumped = {};   ///< the diagonal, if the mass is diagonal; else empty
  std::vector<std::vector<double>> rigid = {};  ///< the six rigid motions as values of the unknowns
};

/// A scheme by name. Automatic: central difference where mass is lumped, nothing damps and Δt is
/// within 0.9 of the limit; else implicit.
enum class TimeScheme : std::uint8_t {
  automatic,
  newmark,
  generalised_alpha,
  central_difference,
  zhai,
  quasi_static
};

/// By name, and the names there are.
TimeScheme time_scheme_of(const std::string& name);
std::vector<std::string> time_scheme_names();

struct Scheme {
  double alpha_m, alpha_f, beta, gamma;
  TimeScheme kind = TimeScheme::automatic;
  double phi = 0, psi = 0;  ///< of Zhai
};

/// `implicit`: what automatic takes beyond the explicit limit.
Scheme make_scheme(TimeScheme, Scheme implicit);
Scheme zhai(double phi, double psi);

/// Largest stable step [s] of central_difference or zhai, at the largest frequency ω [rad/s] and
/// the largest 2ξω [1/s] of a body.
double stable_step(TimeScheme, double omega, double damping);

/// Average acceleration: β ¼, γ ½; keeps the energy of a linear system exactly.
Scheme newmark();
/// Second order, spectral radius → rho_inf at high frequency; 0 ≤ rho_inf ≤ 1 (InputError).
Scheme generalised_alpha(double rho_inf);

/// Motion of the unknowns at t, and the outer force that acted there.
struct Motion {
  std::vector<double> u, v, a, f;
  std::vector<double> a_before = {};  ///< of Zhai: a step earlier; empty at the start
};

class Stepper {
 public:
  /// The matrices must outlive it. \throws InputError if an explicit scheme has no lumped mass.
  Stepper(const Matrices&, Scheme, SolverKind = SolverKind::direct);

  /// \throws InputError unless dt > 0, finite and within the limit of a named explicit scheme;
  /// RunError if the matrix cannot be factorised.
  void set_step(double dt);
  double step() const { return dt_; }
  bool is_explicit() const { return explicit_; }
  /// Largest step without a solve [s]; 0: none.
  double explicit_limit() const {
    return std::isfinite(largest_step_) ? largest_step_ : explicit_limit_;
  }
  /// Of a named explicit scheme [s]; else infinite.
  double largest_step() const { return largest_step_; }
  int iterations() const { return solver_ ? solver_->iterations() : 0; }

  /// u₊ = u + Δt v + Δt² (½+ψ) a − Δt² ψ a₋ of unknown i: exact if explicit, else predicted.
  double predicted(const Motion& s, int i) const {
    const double u = s.u[i] + dt_ * (s.v[i] + (0.5 + scheme_.psi) * dt_ * s.a[i]);
    return s.a_before.empty() ? u - scheme_.psi * dt_ * dt_ * s.a[i]
                              : u - scheme_.psi * dt_ * dt_ * s.a_before[i];
  }

  /// From t to t+Δt under the outer force at t+Δt.
  void advance(Motion&, const std::vector<double>& force);

  /// a = M⁻¹ (f − C v − K u) at t.
  void set_acceleration(Motion&) const;

 private:
  void advance_explicitly(Motion&, const std::vector<double>& force);
  void advance_zhai(Motion&, const std::vector<double>& force);
  void advance_statically(Motion&, const std::vector<double>& force);
  void accelerate(Motion&);
  void advance_implicitly(Motion&, const std::vector<double>& force);

  const Matrices& matrices_;
  Scheme scheme_;
  double dt_ = 0;
  SolverKind kind_;
  std::map<double, LinearSolver> solvers_;
  const LinearSolver* solver_ = nullptr;
  bool explicit_ = false;
  double explicit_limit_ = 0;  ///< of automatic [s]
  double largest_step_ = std::numeric_limits<double>::infinity();
  std::vector<double> m_, c_, k_, rhs_, next_;
};

}  // namespace trackbed::fem
