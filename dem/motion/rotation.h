// Torque-free rotation of a body over a step, and rotation vectors: for one body (Number double,
// and by Vec3 and Quat) or for eight (Eight). A quaternion in an array is x, y, z, w.
#pragma once
#include <cmath>

#include "dem/contact/eight.h"
#include "dem/types.h"

namespace trackbed::dem {

/// sin and cos; a short series where angles of a time step lie (error below 1 ulp for |x| < .05).
template <class Number>
void sin_cos(const Number& x, Number& s, Number& c) {
  const Number y = x * x;
  if (all_less(y, Number(0.0025))) {
    s = x * (1 - y * (1. / 6 - y * (1. / 120 - y * (1. / 5040 - y * (1. / 362880)))));
    c = 1 - y * (1. / 2 - y * (1. / 24 - y * (1. / 720 - y * (1. / 40320))));
  } else {
    s = each(x, [](double a) { return std::sin(a); });
    c = each(x, [](double a) { return std::cos(a); });
  }
}

/// Rotation vector [rad] of a unit quaternion near the identity or anywhere else.
template <class Number>
void rotation_vector(const Number (&q)[4], Number (&r)[3]) {
  // t/sin(t/2), t the angle of q's vector part of squared size s2
  const auto series = [](auto s2) {
    return 2 * (1 + s2 * (1. / 6 + s2 * (3. / 40 + s2 * (15. / 336))));
  };
  const Number s2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
  Number factor = series(s2);
  if (!all_less(s2, Number(1e-4)) || !all_less(Number(0), q[3])) {
    using std::sqrt;
    const Number half = each(s2 / (q[3] * q[3]), [](double y) { return std::atan(std::sqrt(y)); });
    factor = where_less(q[3], 0, -1, 1) * where_less(s2, 1e-4, factor, 2 * half / sqrt(s2));
  }
  for (int d = 0; d < 3; ++d) r[d] = factor * q[d];
}

/// Unit quaternion of a rotation vector [rad].
template <class Number>
void from_rotation_vector(const Number (&r)[3], Number (&q)[4]) {
  const Number y = 0.25 * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);  // of half the angle
  Number s;                                                           // its sine over it
  if (all_less(y, Number(0.0025))) {
    s = 1 - y * (1. / 6 - y * (1. / 120 - y * (1. / 5040 - y * (1. / 362880))));
    q[3] = 1 - y * (1. / 2 - y * (1. / 24 - y * (1. / 720 - y * (1. / 40320))));
  } else {
    s = each(y, [](double a) { return a > 0 ? std::sin(std::sqrt(a)) / std::sqrt(a) : 1; });
    q[3] = each(y, [](double a) { return std::cos(std::sqrt(a)); });
  }
  for (int d = 0; d < 3; ++d) q[d] = 0.5 * s * r[d];
}

/// Turns q about the body's axis `i` by `angle` and takes the body-frame angular momentum along
/// (backwards, since it stands still in the world).
template <int i, class Number>
void turn_about_axis(const Number& angle, Number (&q)[4], Number (&l)[3]) {
  constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
  Number s, c;
  sin_cos(Number(0.5 * angle), s, c);
  // q * (c, s e_i)
  const Number w = q[3], qi = q[i], qj = q[j], qk = q[k];
  q[3] = c * w - s * qi;
  q[i] = c * qi + s * w;
  q[j] = c * qj + s * qk;
  q[k] = c * qk - s * qj;
  const Number ss = 2 * s * c, cc = c * c - s * s, lj = l[j], lk = l[k];
  l[j] = cc * lj + ss * lk;
  l[k] = cc * lk - ss * lj;
}

/// Negative where a body's principal moments of inertia are all the same to rounding.
template <class Number>
Number unlike(const Number (&inertia)[3]) {
  const Number first = inertia[0], a = inertia[1] - first, b = inertia[2] - first;
  return a * a + b * b - 1e-24 * first * first;
}

/// Rotation over h [s] from the identity, body axes: R1(h/2) R2(h/2) R3(h) R2(h/2) R1(h/2).
/// `l`: angular momentum in body (principal) axes [kg m2/s], `inertia` principal moments. Where
/// these are all the same (spheres, cubes) it is one turn about l; the same to rounding, or a cube
/// would turn otherwise when it is scaled.
template <class Number>
void free_rotation(double h, const Number (&inertia)[3], const Number (&momentum)[3],
                   Number (&q)[4]) {
  Number l[3] = {momentum[0], momentum[1], momentum[2]};
  const Number differ = unlike(inertia);
  Number turn[3], at_once[4];
  const bool some_alike = any_less(differ, Number(0));
  if (some_alike) {
    for (int d = 0; d < 3; ++d) turn[d] = h / inertia[0] * l[d];
    from_rotation_vector(turn, at_once);
  }
  for (int d = 0; d < 4; ++d) q[d] = some_alike ? at_once[d] : Number(d == 3);
  if (all_less(differ, Number(0))) return;
  Number split[4] = {0, 0, 0, 1};
  turn_about_axis<0>(Number(h / 2 * l[0] / inertia[0]), split, l);
  turn_about_axis<1>(Number(h / 2 * l[1] / inertia[1]), split, l);
  turn_about_axis<2>(Number(h * l[2] / inertia[2]), split, l);
  turn_about_axis<1>(Number(h / 2 * l[1] / inertia[1]), split, l);
  turn_about_axis<0>(Number(h / 2 * l[0] / inertia[0]), split, l);
  for (int d = 0; d < 4; ++d) q[d] = where_less(differ, 0, q[d], split[d]);
}

inline Vec3 rotation_vector(const Quat& q) {
  const double from[4] = {q.x(), q.y(), q.z(), q.w()};
  double r[3];
  rotation_vector(from, r);
  return Vec3(r[0], r[1], r[2]);
}

inline Quat from_rotation_vector(const Vec3& r) {
  const double from[3] = {r.x(), r.y(), r.z()};
  double q[4];
  from_rotation_vector(from, q);
  return Quat(q[3], q[0], q[1], q[2]);
}

}  // namespace trackbed::dem
