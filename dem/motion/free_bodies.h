// The step of free bodies, eight at a time: no direction of theirs is held. What motion.cc does for
// the others body by body, with the same formulas. Included by motion.cc.
#pragma once
#include <cstring>

#include "dem/contact/eight_vectors.h"
#include "dem/motion/motion.h"
#include "dem/motion/rotation.h"

namespace trackbed::dem {

/// Eight orientations: unit quaternion, and its matrix by columns.
struct EightTurns {
  Eight q[4];  // x, y, z, w
  Eight3 column[3];
};

[[gnu::always_inline]] inline EightTurns read_turns(const Bodies& b, const Eightfold& e) {
  EightTurns t;
  read4(&b.q[0].coeffs(), e, t.q);
  return t;
}

// A body's numbers lie together: they are written in pairs.
[[gnu::always_inline]] inline void write_turns(Bodies& b, const Eightfold& e, const EightTurns& t) {
  write4(&b.q[0].coeffs(), e, t.q);
  const Eight3 *a = t.column, *m = t.column + 1, *z = t.column + 2;
  const Eight R[9] = {a->x, a->y, a->z, m->x, m->y, m->z, z->x, z->y, z->z};
  double pairs[4][16], last[8];
  for (int d = 0; d < 4; ++d) store_pairs(pairs[d], R[2 * d], R[2 * d + 1]);
  R[8].store(last);
  for (int k = 0; k < e.count; ++k) {
    double* to = b.R[e.at[k]].data();
    for (int d = 0; d < 4; ++d) std::memcpy(to + 2 * d, pairs[d] + 2 * k, 2 * sizeof(double));
    to[8] = last[k];
  }
}

[[gnu::always_inline]] inline void make_matrix(EightTurns& t) {
  const Eight x = t.q[0], y = t.q[1], z = t.q[2], w = t.q[3];
  const Eight x2 = x + x, y2 = y + y, z2 = z + z;
  t.column[0] = {1 - (y2 * y + z2 * z), x2 * y + z2 * w, x2 * z - y2 * w};
  t.column[1] = {x2 * y - z2 * w, 1 - (x2 * x + z2 * z), y2 * z + x2 * w};
  t.column[2] = {x2 * z + y2 * w, y2 * z - x2 * w, 1 - (x2 * x + y2 * y)};
}

[[gnu::always_inline]] inline Eight3 to_body(const EightTurns& t, const Eight3& v) {
  return {dot(t.column[0], v), dot(t.column[1], v), dot(t.column[2], v)};
}
[[gnu::always_inline]] inline Eight3 to_world(const EightTurns& t, const Eight3& v) {
  return v.x * t.column[0] + v.y * t.column[1] + v.z * t.column[2];
}

/// p <- p * q, made unit again: one Newton step suffices so near to it.
[[gnu::always_inline]] inline void turn_by(const Eight (&q)[4], Eight (&p)[4]) {
  const Eight x = p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1],
              y = p[3] * q[1] + p[1] * q[3] + p[2] * q[0] - p[0] * q[2],
              z = p[3] * q[2] + p[2] * q[3] + p[0] * q[1] - p[1] * q[0],
              w = p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2];
  const Eight keep = 1.5 - 0.5 * (x * x + y * y + z * z + w * w);
  p[0] = keep * x, p[1] = keep * y, p[2] = keep * z, p[3] = keep * w;
}

/// What a step reads of eight bodies and changes.
struct FreeBodies {
  Eightfold at;
  Eight mass;
  Eight3 v, L, omega;
  Eight inertia[3];
  EightTurns turns;
  bool alike;  ///< all three moments of inertia are the same in all of them

  [[gnu::always_inline]] FreeBodies(const Bodies& b, const Eightfold& e)
      : at(e), mass(read(b.mass.data(), e)), v(read(b.v.data(), e)), L(read(b.L.data(), e)) {
    const Eight3 moments = read(b.inertia.data(), e);
    inertia[0] = moments.x, inertia[1] = moments.y, inertia[2] = moments.z;
    alike = all_less(unlike(inertia), Eight(0));
    if (!alike) turns = read_turns(b, e), make_matrix(turns);
  }
  [[gnu::always_inline]] void update_omega() {
    if (alike) {
      omega = (1 / inertia[0]) * L;
      return;
    }
    const Eight3 l = to_body(turns, L);
    omega = to_world(turns, {l.x / inertia[0], l.y / inertia[1], l.z / inertia[2]});
  }
};

[[gnu::always_inline]] inline Eight with_sign(Eight size, Eight of) {
  return where_less(0, of, size, where_less(of, 0, 0. - size, 0));
}
[[gnu::always_inline]] inline Eight3 against(double share, const Eight3& force, const Eight3& v) {
  return {share * with_sign(abs(force.x), v.x), share * with_sign(abs(force.y), v.y),
          share * with_sign(abs(force.z), v.z)};
}

/// half_kick of motion.cc.
template <bool damped, bool before>
[[gnu::always_inline]] inline StepWork half_kick(FreeBodies& f, const Bodies& b,
                                                 const StepContext& c) {
  const double h = c.dt / 2;
  const Eight3 applied = read(b.applied_force.data(), f.at);
  Eight3 force = read(b.force.data(), f.at) + applied + f.mass * Eight3(c.gravity),
         torque = read(b.torque.data(), f.at), damping, couple;
  if constexpr (damped) {
    f.omega = read(b.omega.data(), f.at);
    damping = against(c.local_damping, force, f.v);
    couple = against(c.local_damping, torque, f.omega);
    force = force - damping;
    torque = torque - couple;
  }
  Eight3 v = f.v, omega;
  if (damped) omega = f.omega;
  f.v = f.v + (h / f.mass) * force;
  f.L = f.L + Eight(h) * torque;
  if (before || damped) f.update_omega();
  if (!before) v = f.v;
  if (!before && damped) omega = f.omega;

  StepWork w;
  w.applied = h * sum_first(dot(applied, v), f.at.count);
  if constexpr (damped)
    w.local_damping = h * sum_first(dot(damping, v) + dot(couple, omega), f.at.count);
  return w;
}

/// Orientation and angular velocity over the step; returns its rotation vector.
[[gnu::always_inline]] inline Eight3 rotate(FreeBodies& f, const Bodies& b, double dt) {
  if (f.alike) {  // one turn about L, from the world's side
    f.update_omega();
    f.turns = read_turns(b, f.at);
    const Eight3 turn = Eight(dt) * f.omega;
    Eight step[4], old[4];
    const Eight vector[3] = {turn.x, turn.y, turn.z};
    from_rotation_vector(vector, step);
    for (int d = 0; d < 4; ++d) old[d] = f.turns.q[d], f.turns.q[d] = step[d];
    turn_by(old, f.turns.q);
    make_matrix(f.turns);
    return turn;
  }
  const Eight3 l = to_body(f.turns, f.L);
  const Eight momentum[3] = {l.x, l.y, l.z};
  Eight step[4], vector[3];
  free_rotation(dt, f.inertia, momentum, step);
  rotation_vector(step, vector);
  const Eight3 turn = to_world(f.turns, {vector[0], vector[1], vector[2]});
  turn_by(step, f.turns.q);
  make_matrix(f.turns);
  f.update_omega();
  return turn;
}

template <bool damped>
StepWork drift_free(Bodies& b, const Eightfold& e, const StepContext& c) {
  FreeBodies f(b, e);
  const StepWork w = half_kick<damped, false>(f, b, c);
  write(b.x.data(), e, read(b.x.data(), e) + Eight(c.dt) * f.v);
  const Eight3 turn = rotate(f, b, c.dt);
  write(b.v.data(), e, f.v);
  write(b.L.data(), e, f.L);
  write(b.omega.data(), e, f.omega);
  write(b.turn.data(), e, turn);
  write_turns(b, e, f.turns);
  return w;
}

template <bool damped>
StepWork kick_free(Bodies& b, const Eightfold& e, const StepContext& c) {
  FreeBodies f(b, e);
  const StepWork w = half_kick<damped, true>(f, b, c);
  write(b.v.data(), e, f.v);
  write(b.L.data(), e, f.L);
  write(b.omega.data(), e, f.omega);
  return w;
}

}  // namespace trackbed::dem
