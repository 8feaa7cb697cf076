// One step of all bodies: velocity Verlet in two halves around the force evaluation,
//
//   drift:  v += dt/2 F/m,  L += dt/2 T,  x += dt v,  orientation by a symplectic splitting
//   ...     forces at the new places, outer loads of the new time ...
//   kick:   v += dt/2 F/m,  L += dt/2 T
//
// F = contact force + applied force + m g [N], T = contact torque about the centre of mass [N m],
// L = angular momentum in world axes [kg m2/s]. Second order, time-reversible, no energy drift.
//
// Rotation between the kicks is torque-free, so L in world axes does not change at all; the
// orientation follows R1(h/2) R2(h/2) R3(h) R2(h/2) R1(h/2), each a turn about one principal
// axis by h L_i/I_i (Dullweber, Leimkuhler, McLachlan, J. Chem. Phys. 107 (1997) 5840). The
// gyroscopic term omega x (I omega) is contained.
//
// Directions whose Freedom bit is not set keep the velocity that their driver put into v, omega.
#pragma once
#include <limits>

#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// What one step needs besides the bodies; rebuilt by the run loop each step.
struct StepContext {
  double dt = std::numeric_limits<double>::quiet_NaN();  ///< [s]
  Vec3 gravity = Vec3(0, 0, -9.81);                      ///< [m/s2]
  double local_damping = 0;    ///< lambda of F_d = -lambda |F| sign(v); 0 = none
  Vec3 period = Vec3::Zero();  ///< box length in a periodic direction [m], 0 = not periodic
  int threads = 1;
  /// Of these, for a pass over so many bodies: few are as quickly done as a thread is told.
  int threads_for(int bodies) const { return bodies > 100 ? threads : 1; }
};

/// Work and loss of one half of a step [J], for the energy ledger. Loads act along the step's
/// displacement, half of it with the force at its start (drift), half with that at its end (kick).
struct StepWork {
  double applied = 0;        ///< work of Bodies::applied_force
  double prescribed = 0;     ///< work of what moves the prescribed directions
  double local_damping = 0;  ///< energy taken by local damping
  StepWork& operator+=(const StepWork& w) {
    applied += w.applied, prescribed += w.prescribed, local_damping += w.local_damping;
    return *this;
  }
};

/// First half kick with the forces of the last evaluation, then the move by dt.
/// Leaves v, omega of mid-step, x, q, R of the new time and `turn`, the step's rotation vector.
StepWork drift(Bodies&, const StepContext&);

/// Second half kick with the forces at the new places; omega follows.
StepWork kick(Bodies&, const StepContext&);

/// Sets angular velocity (world axes, rad/s) and the angular momentum that belongs to it.
void set_spin(Bodies&, int body, const Vec3& omega);

/// Inertia tensor about the centre of mass in world axes [kg m2].
inline Mat3 world_inertia(const Bodies& b, int i) {
  return b.R[i] * b.inertia[i].asDiagonal() * b.R[i].transpose();
}

}  // namespace trackbed::dem
