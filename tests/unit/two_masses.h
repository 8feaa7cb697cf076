// The coupled system of two masses, run by the real code: its growth per step under every exchange
// schedule.
#pragma once
#include <Eigen/Eigenvalues>

#include "coupling_scene.h"

namespace trackbed::coupling {

/// The structure's mass and its spring to the ground, the contact's spring; the grain's mass is 1.
struct TwoMasses {
  double mass = 2, ground = 3, contact = 4;

  /// Largest frequency [rad/s]: 2.56699322 for the masses and springs above.
  double omega() const {
    Eigen::Matrix2d k;
    k << contact, -contact / std::sqrt(mass), -contact / std::sqrt(mass), (contact + ground) / mass;
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(k).eigenvalues().maxCoeff());
  }
};

// A unit cube lies flat on the structure, pressed by a load, and moves up and down only. Face on
// face the contact force is that of the spring x depth, to (depth/1)^4.
inline constexpr double kDepth = .01;
inline constexpr int kStates = 8;
using State = Eigen::Matrix<double, kStates, 1>;

inline Exchange exchange(const char* schedule, int grain_steps = 1) {
  Exchange e;
  e.schedule = schedule_named(schedule);
  e.grain_steps = grain_steps;
  e.tolerance = 1e-13;
  return e;
}

// One exchange of the real code on (x, v, F/m of the grain; u, v, a of the structure; the force it
// was given last and the impulse it is owed), taken from the state of balance.
inline State one_exchange(const State& s, double dt, const Exchange& e, const TwoMasses& m = {}) {
  World w;
  w.exchange = e;
  set_materials(w, m.contact / .7522527780636751, 0);
  add_grain(w, dem::make_box({1, 1, 1}), 1, {0, 0, .5}, Quat::Identity(), dem::kMoveZ);
  auto owned =
      std::make_unique<MassOnSpring>(m.mass, m.ground, 2., e.schedule == Schedule::both_explicit);
  MassOnSpring& structure = *owned;
  w.surfaces.push_back(make_surface("mass", 0, .1, 0, Vec3::Zero(), std::move(owned)));
  Surface& surface = w.surfaces[0];
  set_step(w, dt);
  const dem::StepContext c = context(dt, Vec3::Zero());
  const double load = m.contact * kDepth;
  w.bodies.applied_force[0] = Vec3(0, 0, -load);
  const double sunk = load / m.ground;
  w.bodies.x[0].z() = .5 - sunk - kDepth + s[0];
  structure.u = -sunk + s[3];
  for (int i = 0; i < surface.patch.carried; ++i) surface.patch.node[i].z() = structure.u;
  dem::StepContext still = c;
  still.dt = 0;
  prepare(w, still);
  w.bodies.v[0].z() = s[1];
  w.bodies.force[0].z() = load + s[2];
  structure.v = s[4], structure.a = s[5];
  for (int i = 0; i < 4; ++i) {
    surface.last_force[i] = Vec3(0, 0, -(load + s[2]) / 4);
    surface.given[i] = Vec3(0, 0, -(load + s[6]) / 4);
    surface.owed[i] = surface.owed_before[i] = Vec3(0, 0, -s[7] / 4);
  }
  advance(w, c, [](World&, double) {});
  double given = 0, owed = 0;
  for (int i = 0; i < 4; ++i) given -= surface.given[i].z(), owed -= surface.owed[i].z();
  State next;
  next << w.bodies.x[0].z() - (.5 - sunk - kDepth), w.bodies.v[0].z(), w.bodies.force[0].z() - load,
      structure.u + sunk, structure.v, structure.a, given - load, owed;
  return next;
}

// Per grain step at W = omega dt.
inline double growth(double W, const Exchange& e, const TwoMasses& m = {}) {
  Eigen::Matrix<double, kStates, kStates> map;
  const double h = 1e-5;
  for (int k = 0; k < kStates; ++k)
    map.col(k) = (one_exchange(h * State::Unit(k), W / m.omega(), e, m) -
                  one_exchange(-h * State::Unit(k), W / m.omega(), e, m)) /
                 (2 * h);
  const int used = e.grain_steps > 1 ? kStates : kStates - 2;
  const double largest = Eigen::EigenSolver<Eigen::MatrixXd>(map.topLeftCorner(used, used))
                             .eigenvalues()
                             .cwiseAbs()
                             .maxCoeff();
  return std::pow(largest, 1. / e.grain_steps) - 1;
}

}  // namespace trackbed::coupling
