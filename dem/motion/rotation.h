// Torque-free rotation of one body over a step, and rotation vectors.
#pragma once
#include <cmath>

#include "dem/types.h"

namespace trackbed::dem {

/// sin and cos; a short series where angles of a time step lie (error below 1 ulp for |x| < .05).
inline void sin_cos(double x, double& s, double& c) {
  const double y = x * x;
  if (y < 0.0025) {
    s = x * (1 - y * (1. / 6 - y * (1. / 120 - y * (1. / 5040 - y * (1. / 362880)))));
    c = 1 - y * (1. / 2 - y * (1. / 24 - y * (1. / 720 - y * (1. / 40320))));
  } else {
    s = std::sin(x);
    c = std::cos(x);
  }
}

/// Rotation vector [rad] of a unit quaternion near the identity or anywhere else.
inline Vec3 rotation_vector(const Quat& q) {
  const double s2 = q.vec().squaredNorm();
  if (q.w() > 0 && s2 < 1e-4)
    return 2 * (1 + s2 * (1. / 6 + s2 * (3. / 40 + s2 * (15. / 336)))) * q.vec();
  const double s = std::sqrt(s2), sense = q.w() < 0 ? -1 : 1;
  return 2 * std::atan2(s, sense * q.w()) * sense / s * q.vec();
}

/// Unit quaternion of a rotation vector [rad].
inline Quat from_rotation_vector(const Vec3& r) {
  const double t = r.norm();
  if (t < 1e-8) return Quat(1, r.x() / 2, r.y() / 2, r.z() / 2).normalized();
  double s, c;
  sin_cos(t / 2, s, c);
  const Vec3 v = s / t * r;
  return Quat(c, v.x(), v.y(), v.z());
}

/// Turns q about the body's axis `i` by `angle` and takes the body-frame angular momentum along
/// (backwards, since it stands still in the world).
template <int i>
void turn_about_axis(double angle, Quat& q, Vec3& l) {
  constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
  double s, c;
  sin_cos(angle / 2, s, c);
  // q * (c, s e_i)
  const double w = q.w(), vi = q.vec()[i], vj = q.vec()[j], vk = q.vec()[k];
  q.w() = c * w - s * vi;
  q.vec()[i] = c * vi + s * w;
  q.vec()[j] = c * vj + s * vk;
  q.vec()[k] = c * vk - s * vj;
  const double ss = 2 * s * c, cc = c * c - s * s, lj = l[j], lk = l[k];
  l[j] = cc * lj + ss * lk;
  l[k] = cc * lk - ss * lj;
}

/// Rotation over h [s] from the identity, body axes: R1(h/2) R2(h/2) R3(h) R2(h/2) R1(h/2).
/// `l`: angular momentum in body (principal) axes [kg m2/s], `inertia` principal moments. Where
/// these are all the same (spheres, cubes) it is one turn about l; the same to rounding, or a cube
/// would turn otherwise when it is scaled.
inline Quat free_rotation(double h, const Vec3& inertia, Vec3 l) {
  const double same = 1e-12 * inertia[0];
  if (std::abs(inertia[1] - inertia[0]) <= same && std::abs(inertia[2] - inertia[0]) <= same)
    return from_rotation_vector(h / inertia[0] * l);
  Quat q = Quat::Identity();
  turn_about_axis<0>(h / 2 * l[0] / inertia[0], q, l);
  turn_about_axis<1>(h / 2 * l[1] / inertia[1], q, l);
  turn_about_axis<2>(h * l[2] / inertia[2], q, l);
  turn_about_axis<1>(h / 2 * l[1] / inertia[1], q, l);
  turn_about_axis<0>(h / 2 * l[0] / inertia[0], q, l);
  return q;
}

}  // namespace trackbed::dem
