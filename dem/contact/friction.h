// Incremental Coulomb friction at one contact, grain on grain and grain on surface alike.
//
//   k_t = kappa 4E/(3 sqrt(pi)) sqrt(A)                                   [N/m]
//   F_t <- turned with the contact, into the new tangent plane, size kept [N]
//   F_t <- F_t min(1, k_t/k_t,old)        a shrinking contact lets go of energy, never gains it
//   F_t <- F_t - k_t du_t,  |F_t| <= mu |F_n|   (a growing one: mean of old and new k_t)
//
// kappa = PairMaterial::tangential_ratio, A size of the overlap's vector area [m2], du the
// displacement of a's material point at the contact relative to b's over the step [m], mu friction
// coefficient, n = F_n/|F_n|. Source: Shao, Lian, Yang 2017, Eq. 19, dF_s = k_s du_s A with
// k_s = kappa 4E/(3 sqrt(pi)): that product has the unit N m; sqrt(A) makes it a force and gives
// k_t/k_n = kappa for face on face.
#pragma once
#include <algorithm>
#include <cmath>

#include "dem/contact/eight_vectors.h"
#include "dem/contact/laws/pressure_law.h"

namespace trackbed::dem {

/// k_t [N/m] of a contact with vector area of size `area` [m2].
inline double tangential_stiffness(const PairMaterial& m, double area) {
  return m.tangential_ratio * kShaoFactor * m.modulus * std::sqrt(area);
}

/// How one contact moved over the step. V: Vec3, or Eight3 for eight contacts.
template <class V>
struct SlipOf {
  V displacement;  ///< of a's material point relative to b's, mid-step arms [m]
  V turn;          ///< mean rotation vector of both bodies [rad]
};
using ContactSlip = SlipOf<Vec3>;

/// The vector w with D_new - D_old = w x (D_new + D_old)/2 for D turned by `turn`:
/// w = tan(t/2)/(t/2) turn. With it a pair that moves as one rigid body slips by exactly nothing.
template <class V>
[[gnu::always_inline]] inline V secant_turn(const V& turn) {
  using Number = NumberOf<V>;
  const Number h2 = 0.25 * squared_norm(turn);  // (t/2)^2
  const auto series = [](auto y) { return 1 + y * (1. / 3 + y * (2. / 15 + y * (17. / 315))); };
  if (all_less(h2, Number(1e-4))) return series(h2) * turn;
  const Number factor = each(
      h2, [&](double y) { return y < 1e-4 ? series(y) : std::tan(std::sqrt(y)) / std::sqrt(y); });
  return factor * turn;
}

/// v turned by a rotation vector (Rodrigues).
template <class V>
[[gnu::always_inline]] inline V turned(const V& v, const V& turn) {
  using Number = NumberOf<V>;
  const Number t2 = squared_norm(turn);
  Number s, c;  // sin t / t, (1 - cos t)/t^2
  if (all_less(t2, Number(1e-3))) {
    s = 1 - t2 * (1. / 6 - t2 * (1. / 120 - t2 * (1. / 5040 - t2 * (1. / 362880))));
    c = 0.5 - t2 * (1. / 24 - t2 * (1. / 720 - t2 * (1. / 40320 - t2 * (1. / 3628800))));
  } else {
    s = each(t2, [](double y) { return y > 0 ? std::sin(std::sqrt(y)) / std::sqrt(y) : 1; });
    c = each(t2, [](double y) {  // 2 sin^2(t/2)/t^2
      const double half = std::sin(std::sqrt(y) / 2);
      return y > 0 ? 2 * half * half / y : .5;
    });
  }
  const V u = cross(turn, v);
  return v + s * u + c * cross(turn, u);
}

/// Slip of the step from the bodies' own motion: velocities v of mid-step, rotation vectors, arms
/// from each centre to the contact point at the start and end of the step.
template <class V>
[[gnu::always_inline]] inline SlipOf<V> contact_slip(double dt, const V& va, const V& turn_a,
                                                     const V& arm_a_old, const V& arm_a,
                                                     const V& vb, const V& turn_b,
                                                     const V& arm_b_old, const V& arm_b) {
  const V at_a = 0.5 * (arm_a_old + arm_a), at_b = 0.5 * (arm_b_old + arm_b);
  return {dt * (va - vb) + cross(secant_turn(turn_a), at_a) - cross(secant_turn(turn_b), at_b),
          0.5 * (turn_a + turn_b)};
}

template <class Number>
struct FrictionOf {
  Number stored = 0;      ///< F_t^2/(2 k_t) [J]
  Number dissipated = 0;  ///< in this step: slip work + what a changing stiffness lost [J]
};
using FrictionResult = FrictionOf<double>;

/// Advances `force` (on a) and `stiffness` (0 = contact is new, no force) to the tangential
/// stiffness k [N/m]. `n` unit normal, either sense; `normal_force` its size [N]; `friction`
/// Coulomb's coefficient.
template <class V>
[[gnu::always_inline]] inline FrictionOf<NumberOf<V>> advance_friction(
    const NumberOf<V>& friction, const NumberOf<V>& k, const V& n, const NumberOf<V>& normal_force,
    const SlipOf<V>& slip, V& force, NumberOf<V>& stiffness) {
  using Number = NumberOf<V>;
  using std::sqrt;
  const Number zero = 0, one = 1, k_old = stiffness;
  const Number size2 = where_less(zero, k_old, squared_norm(force), zero);
  V old = zero * n;
  if (any_less(zero, size2)) {
    old = turned(force, slip.turn);
    old = old - dot(n, old) * n;
    const Number flat2 = squared_norm(old);
    old = where_less(zero, flat2, sqrt(size2 / flat2), zero) * old;
  }
  const V du = slip.displacement - dot(n, slip.displacement) * n;
  // What this step's displacement meets: growing contact, the mean stiffness; shrinking, the new
  // one on what the spring keeps.
  const auto inverse = [&](const Number& a) { return where_less(zero, a, one / a, zero); };
  const Number per_old = inverse(k_old), per_new = inverse(k);
  const Number k_step = where_less(k, k_old, k, 0.5 * (k_old + k)),
               per_step = where_less(k, k_old, per_new, inverse(k_step));
  const V trial = where_less(k, k_old, k * per_old, one) * old - k_step * du;
  const Number cap = friction * normal_force, size = sqrt(squared_norm(trial));
  force = where_less(cap, size, cap / size, one) * trial;
  // Slip (F - F_trial)/k against the mean of the forces at the step's start and end.
  const Number slid =
      where_less(cap, size, 0.5 * per_step * dot(V(old + force), V(trial - force)), zero);
  const Number force2 = squared_norm(force);
  // What the lost area held is gone, or what the area that is new does not hold.
  const Number shrunk =
                   0.25 * (size2 * per_old * per_old + force2 * per_new * per_new) * (k_old - k),
               grown = 0.5 * (size2 * (per_old - per_step) + force2 * (per_step - per_new));
  stiffness = k;
  FrictionOf<Number> result;
  result.stored = 0.5 * force2 * per_new;
  result.dissipated = slid + where_less(k, k_old, shrunk, grown);
  return result;
}

/// The same with k from the contact's area [m2].
inline FrictionResult advance_friction(const PairMaterial& m, const Vec3& n, double normal_force,
                                       double area, const ContactSlip& slip, Vec3& force,
                                       double& stiffness) {
  return advance_friction(m.friction, tangential_stiffness(m, area), n, normal_force, slip, force,
                          stiffness);
}

}  // namespace trackbed::dem
