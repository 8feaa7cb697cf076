#include "dem/motion/motion.h"

#include <cmath>

#include "dem/contact/fetch.h"
#include "dem/motion/free_bodies.h"
#include "dem/motion/ordered_sum.h"
#include "dem/motion/rotation.h"

namespace trackbed::dem {
namespace {

constexpr int kTurnAll = kTurnX | kTurnY | kTurnZ;

Vec3 sign(const Vec3& v) {
  return v.unaryExpr([](double c) { return double(c > 0) - double(c < 0); });
}

/// 1 for each free direction of three bits.
Vec3 mask(int bits) { return Vec3(bits & 1, bits >> 1 & 1, bits >> 2 & 1); }

void update_omega(Bodies& b, int i) {
  const int turns = b.freedom[i] & kTurnAll;
  if (turns == kTurnAll) {
    const Vec3 l = b.R[i].transpose() * b.L[i];
    b.omega[i] = b.R[i] * l.cwiseQuotient(b.inertia[i]);
  } else if (turns != 0) {
    const int axis = turns == kTurnX ? 0 : turns == kTurnY ? 1 : 2;
    b.omega[i] = Vec3::Unit(axis) * (b.L[i][axis] / world_inertia(b, i)(axis, axis));
  } else {
    b.L[i] = world_inertia(b, i) * b.omega[i];
  }
}

/// v += h F/m, L += h T along the free directions; damped: F -= lambda |F| sign(v). Work and loss
/// go along the mid-step velocity, the one before (kick) or after (drift) the change.
template <bool damped, bool before>
StepWork half_kick(Bodies& b, int i, const StepContext& c) {
  const double h = c.dt / 2;
  const Vec3 free = mask(b.freedom[i]), turns = mask(b.freedom[i] >> 3);
  Vec3 f = (b.force[i] + b.applied_force[i] + b.mass[i] * c.gravity).cwiseProduct(free);
  Vec3 t = b.torque[i].cwiseProduct(turns);
  Vec3 fd, td;
  if constexpr (damped) {
    fd = c.local_damping * f.cwiseAbs().cwiseProduct(sign(b.v[i]));
    td = c.local_damping * t.cwiseAbs().cwiseProduct(sign(b.omega[i]));
    f -= fd;
    t -= td;
  }
  const Vec3 v_old = b.v[i], omega_old = b.omega[i];
  b.v[i] += h / b.mass[i] * f;
  b.L[i] += h * t;
  if (before || damped) update_omega(b, i);  // drift's omega follows after the move

  StepWork w;
  const Vec3 v = before ? v_old : b.v[i], omega = before ? omega_old : b.omega[i];
  w.applied = h * b.applied_force[i].dot(v.cwiseProduct(free));
  if (b.freedom[i] != kFree)
    w.prescribed = -h * (b.force[i].dot(v.cwiseProduct(Vec3::Ones() - free)) +
                         b.torque[i].dot(omega.cwiseProduct(Vec3::Ones() - turns)));
  if constexpr (damped) w.local_damping = h * (fd.dot(v) + td.dot(omega));
  return w;
}

void move(Bodies& b, int i, double dt) {
  b.x[i] += dt * b.v[i];
  const int turns = b.freedom[i] & kTurnAll;
  if (turns == kTurnAll) {
    const Vec3 l = b.R[i].transpose() * b.L[i], &inertia = b.inertia[i];
    const double moments[3] = {inertia[0], inertia[1], inertia[2]},
                 momentum[3] = {l[0], l[1], l[2]};
    double step[4];
    free_rotation(dt, moments, momentum, step);
    const Quat turn(step[3], step[0], step[1], step[2]);
    b.turn[i] = b.R[i] * rotation_vector(turn);
    b.q[i] = (b.q[i] * turn).normalized();
  } else {
    if (turns != 0) update_omega(b, i);
    b.turn[i] = dt * b.omega[i];
    if (b.turn[i] == Vec3::Zero()) return;
    b.q[i] = (from_rotation_vector(b.turn[i]) * b.q[i]).normalized();
  }
  b.R[i] = b.q[i].toRotationMatrix();
  update_omega(b, i);
}

// What a half step reads of eight bodies from i on, asked for before it is needed: these are more
// arrays than the processor follows by itself. `moves`: a drift.
template <bool moves>
[[gnu::always_inline]] inline void fetch_bodies(const Bodies& b, int i) {
  for (const auto* v : {&b.v, &b.L, &b.omega, &b.inertia, &b.force, &b.torque, &b.applied_force})
    fetch_lines(&(*v)[i], 3);
  fetch_lines(&b.mass[i], 1);
  if (!moves) return;
  fetch_lines(&b.x[i], 3), fetch_lines(&b.turn[i], 3);
  fetch_lines(&b.q[i], 4), fetch_lines(&b.R[i], 9);
}

// All bodies by eights; `free` for those of them that move freely, `held` for each other one.
template <bool moves, class Free, class Held>
StepWork each_eight(Bodies& b, const StepContext& c, Free&& free, Held&& held) {
  constexpr int kAhead = 32, kMany = 2000;  // fewer stay in the processor's own cache
  const int n = b.size();
  return ordered_sum<StepWork>((n + 7) / 8, c.threads_for(n), [&](int row) {
    if (n > kMany && 8 * row + kAhead + 8 <= n) fetch_bodies<moves>(b, 8 * row + kAhead);
    if (8 * row + 8 <= n && all_are(&b.freedom[8 * row], kFree))
      return free(Eightfold::row(8 * row, 8));
    StepWork w;
    Eightfold e;
    for (int i = 8 * row; i < std::min(n, 8 * row + 8); ++i) {
      if (b.freedom[i] == kFree)
        e.add(i);
      else
        w += held(i);
    }
    if (e.count == 0) return w;
    e.complete();
    w += free(e);
    return w;
  });
}

template <bool damped>
StepWork drift_all(Bodies& b, const StepContext& c) {
  return each_eight<true>(
      b, c, [&](const Eightfold& e) { return drift_free<damped>(b, e, c); },
      [&](int i) {
        const StepWork w = half_kick<damped, false>(b, i, c);
        move(b, i, c.dt);
        return w;
      });
}

template <bool damped>
StepWork kick_all(Bodies& b, const StepContext& c) {
  return each_eight<false>(
      b, c, [&](const Eightfold& e) { return kick_free<damped>(b, e, c); },
      [&](int i) { return half_kick<damped, true>(b, i, c); });
}

}  // namespace

StepWork drift(Bodies& b, const StepContext& c) {
  return c.local_damping == 0 ? drift_all<false>(b, c) : drift_all<true>(b, c);
}

StepWork kick(Bodies& b, const StepContext& c) {
  return c.local_damping == 0 ? kick_all<false>(b, c) : kick_all<true>(b, c);
}

void set_spin(Bodies& b, int i, const Vec3& omega) {
  b.omega[i] = omega;
  b.L[i] = world_inertia(b, i) * omega;
}

}  // namespace trackbed::dem
