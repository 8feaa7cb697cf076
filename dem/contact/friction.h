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

#include "dem/contact/laws/pressure_law.h"

namespace trackbed::dem {

/// 4/(3 sqrt(pi)) of Shao 2017 Eq. 17.
inline constexpr double kShaoFactor = 0.75225277806367504925;

/// k_t [N/m] of a contact with vector area of size `area` [m2].
inline double tangential_stiffness(const PairMaterial& m, double area) {
  return m.tangential_ratio * kShaoFactor * m.modulus * std::sqrt(area);
}

/// How one contact moved over the step.
struct ContactSlip {
  Vec3 displacement;  ///< of a's material point relative to b's, mid-step arms [m]
  Vec3 turn;          ///< mean rotation vector of both bodies [rad]
};

/// The vector w with D_new - D_old = w x (D_new + D_old)/2 for D turned by `turn`:
/// w = tan(t/2)/(t/2) turn. With it a pair that moves as one rigid body slips by exactly nothing.
inline Vec3 secant_turn(const Vec3& turn) {
  const double h2 = turn.squaredNorm() / 4;  // (t/2)^2
  if (h2 < 1e-4) return (1 + h2 * (1. / 3 + h2 * (2. / 15 + h2 * (17. / 315)))) * turn;
  const double h = std::sqrt(h2);
  return std::tan(h) / h * turn;
}

/// v turned by a rotation vector (Rodrigues).
inline Vec3 turned(const Vec3& v, const Vec3& turn) {
  const double t2 = turn.squaredNorm();
  double s, c;  // sin t / t, (1 - cos t)/t^2
  if (t2 < 1e-3) {
    s = 1 - t2 * (1. / 6 - t2 * (1. / 120 - t2 * (1. / 5040 - t2 * (1. / 362880))));
    c = 0.5 - t2 * (1. / 24 - t2 * (1. / 720 - t2 * (1. / 40320 - t2 * (1. / 3628800))));
  } else {
    const double t = std::sqrt(t2);
    s = std::sin(t) / t;
    c = (1 - std::cos(t)) / t2;
  }
  const Vec3 u = turn.cross(v);
  return v + s * u + c * turn.cross(u);
}

/// Slip of the step from the bodies' own motion: velocities v of mid-step, rotation vectors, arms
/// from each centre to the contact point at the start and end of the step.
inline ContactSlip contact_slip(double dt, const Vec3& va, const Vec3& turn_a,
                                const Vec3& arm_a_old, const Vec3& arm_a, const Vec3& vb,
                                const Vec3& turn_b, const Vec3& arm_b_old, const Vec3& arm_b) {
  return {dt * (va - vb) + secant_turn(turn_a).cross((arm_a_old + arm_a) / 2) -
              secant_turn(turn_b).cross((arm_b_old + arm_b) / 2),
          (turn_a + turn_b) / 2};
}

struct FrictionResult {
  double stored = 0;      ///< F_t^2/(2 k_t) [J]
  double dissipated = 0;  ///< in this step: slip work + what a changing stiffness lost [J]
};

/// Advances `force` (on a) and `stiffness` (0 = contact is new) to the tangential stiffness k
/// [N/m]. `n` unit normal, either sense; `normal_force` its size [N]; `friction` Coulomb's
/// coefficient.
inline FrictionResult advance_friction(double friction, double k, const Vec3& n,
                                       double normal_force, const ContactSlip& slip, Vec3& force,
                                       double& stiffness) {
  const double k_old = stiffness;
  FrictionResult result;
  Vec3 old = Vec3::Zero();
  const double size2 = k_old > 0 ? force.squaredNorm() : 0;
  if (size2 > 0) {
    old = turned(force, slip.turn);
    old -= n.dot(old) * n;
    const double flat2 = old.squaredNorm();
    if (flat2 > 0) old *= std::sqrt(size2 / flat2);
  }
  const Vec3 du = slip.displacement - n.dot(slip.displacement) * n;
  // What this step's displacement meets: growing contact, the mean stiffness; shrinking, the new
  // one on what the spring keeps.
  const double k_step = k < k_old ? k : (k_old + k) / 2;
  const Vec3 trial = k < k_old ? Vec3(k / k_old * old - k * du) : Vec3(old - k_step * du);
  const double cap = friction * normal_force, size = trial.norm();
  force = trial;
  if (size > cap) {
    force *= cap / size;
    // Slip (F - F_trial)/k against the mean of the forces at the step's start and end.
    result.dissipated = (old + force).dot(trial - force) / (2 * k_step);
  }
  if (k < k_old) {  // what the lost area held is gone
    const double s2 = size2 / (k_old * k_old) + (k > 0 ? force.squaredNorm() / (k * k) : 0);
    result.dissipated += s2 / 4 * (k_old - k);
  } else if (k_step > 0) {  // what the area that is new does not hold
    if (k_old > 0) result.dissipated += size2 * (1 / k_old - 1 / k_step) / 2;
    result.dissipated += force.squaredNorm() * (1 / k_step - 1 / k) / 2;
  }
  stiffness = k;
  if (k > 0) result.stored = force.squaredNorm() / (2 * k);
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
