// Implicit time integration of M a + C v + K u = f with constant matrices (generalised-α of Chung
// and Hulbert 1993, Newmark's average acceleration as a special case). One solve a step; the factor
// is kept per step size.
//
// With a diagonal mass and no damping, steps up to 0.9·2/ω_max go by velocity Verlet, without a
// solve:
//   u₊ = u + Δt v + ½Δt² a,  a₊ = M⁻¹(f₊ − K u₊),  v₊ = v + ½Δt (a + a₊)
// else
//   (1−α_m) M a₊ + α_m M a + (1−α_f)(C v₊ + K u₊) + α_f (C v + K u) = (1−α_f) f₊ + α_f f
//   u₊ = u + Δt v + Δt² ((½−β) a + β a₊),   v₊ = v + Δt ((1−γ) a + γ a₊)
#pragma once
#include <map>
#include <vector>

#include "fem/linear_solver.h"
#include "fem/sparse.h"

namespace trackbed::fem {

struct Matrices {
  Pattern pattern;
  std::vector<double> stiffness, mass;
  std::vector<double> damping = {};  ///< empty: none
  std::vector<double> lumped = {};   ///< the diagonal, if the mass is diagonal; else empty
};

struct Scheme {
  double alpha_m, alpha_f, beta, gamma;
};

/// Average acceleration: β ¼, γ ½; keeps the energy of a linear system exactly.
Scheme newmark();
/// Second order, spectral radius → rho_inf at high frequency; 0 ≤ rho_inf ≤ 1 (InputError).
Scheme generalised_alpha(double rho_inf);

/// Motion of the unknowns at t, and the outer force that acted there.
struct Motion {
  std::vector<double> u, v, a, f;
};

class Stepper {
 public:
  Stepper(const Matrices&, Scheme);  ///< the matrices must outlive it

  /// \throws InputError unless dt > 0 and finite; RunError if the matrix cannot be factorised.
  void set_step(double dt);
  double step() const { return dt_; }
  bool is_explicit() const { return explicit_; }
  /// Largest step without a solve [s]; 0: none.
  double explicit_limit() const { return explicit_limit_; }

  /// From t to t+Δt under the outer force at t+Δt.
  void advance(Motion&, const std::vector<double>& force);

  /// a = M⁻¹ (f − C v − K u) at t.
  void set_acceleration(Motion&) const;

 private:
  void advance_explicitly(Motion&, const std::vector<double>& force);
  void advance_implicitly(Motion&, const std::vector<double>& force);

  const Matrices& matrices_;
  Scheme scheme_;
  double dt_ = 0;
  std::map<double, Factor> factors_;
  const Factor* factor_ = nullptr;
  bool explicit_ = false;
  double explicit_limit_ = 0;  ///< [s]
  std::vector<double> m_, c_, k_, rhs_, next_;
};

}  // namespace trackbed::fem
