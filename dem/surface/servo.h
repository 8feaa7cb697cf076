// A wall that keeps a force: a prescribed motion whose speed follows from the force that lacks.
//
//   v = G e + w,   dw/dt = G e/T,   e = target - force on the wall [N]
//   G = a/(K dt),  T = dt n          a = 0.5, n = 200
//
// K [N/m] is the normal stiffness of the wall's own contacts: of all that lies behind the wall the
// stiffest part, so that a step's move changes the force by no more than a e. To the grains such a
// wall is a dashpot 1/G and a mass T/G in a row under the target force: it takes energy and never
// makes any. w takes away the error that a steady motion needs; with T = 200 dt its answer is
// overdamped on an assembly down to 1/25 of K (a n K'/K >= 4).
#pragma once
#include "dem/contact/pairs.h"
#include "dem/types.h"

namespace trackbed::dem {

/// Sum over a body's touching contacts of k_n (n . axis)^2 [N/m].
double wall_stiffness(const Pairs&, int body, const Vec3& axis);

/// Speed [m/s] towards the grains of a wall that they push back with `force` [N], for the next step
/// of dt [s]. Never more than `fastest` [m/s], which is also the speed towards grains that it does
/// not touch yet. `drift` is w, kept from step to step; it rests while the speed is at its limit.
double servo_speed(double target, double force, double stiffness, double dt, double fastest,
                   double& drift);

}  // namespace trackbed::dem
