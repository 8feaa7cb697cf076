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

/// What carries the surface: a mass on a spring, or finite elements.
enum class Ground { spring, element };

/// A column of one element, held at its base, Poisson's ratio 0: pressed evenly its top is a mass
/// on a spring, rho A h/3 (lumped: rho A h/2) on E A/h, of these.
inline fem::ElasticBodyParameters column(const TwoMasses& m, bool verlet) {
  const double width = 4, height = 1, area = width * width;
  fem::ElasticBodyParameters p = block(m.ground * height / area, {width, width, height}, {1, 1, 1});
  p.materials[0].poisson = 0;
  p.materials[0].density = (verlet ? 2 : 3) * m.mass / (area * height);
  p.mass = verlet ? fem::Mass::lumped : fem::Mass::consistent;
  p.scheme = verlet ? fem::TimeScheme::central_difference : fem::TimeScheme::newmark;
  return p;
}

/// The vertical motion of what carries the surface, as a mean over its top: a quad's nodes share
/// its pressure by triangles, so not quite evenly, but that only tilts and warps it.
class Top {
 public:
  Top(fem::Structure& s, double force) : structure_(s) {
    if (dynamic_cast<MassOnSpring*>(&s)) return;
    // The unknowns that an even push of the body at rest moves.
    s.save(state_);
    unknowns_ = (state_.size() - 5 - 3 * s.surface().nodes.size()) / 4;
    const std::vector<double> rest = state_;
    s.set_step(1e-3);
    s.advance(std::vector<fem::Vec>(s.surface().nodes.size(), fem::Vec{0, 0, force}));
    s.save(state_);
    const auto a = state_.begin() + static_cast<std::ptrdiff_t>(2 * unknowns_);
    double largest = 0;
    for (std::size_t i = 0; i < unknowns_; ++i) largest = std::max(largest, std::abs(a[i]));
    for (std::size_t i = 0; i < unknowns_; ++i)
      if (std::abs(a[i]) > .5 * largest) at_.push_back(i);
    s.load(rest);
    state_ = rest;
  }
  void put(double u, double v, double a, double force) {
    if (auto* spring = dynamic_cast<MassOnSpring*>(&structure_)) {
      spring->u = u, spring->v = v, spring->a = a;
      return;
    }
    const double values[] = {u, v, a, force / static_cast<double>(at_.size())};
    for (std::size_t field = 0; field < 4; ++field)
      for (const std::size_t i : at_) state_[field * unknowns_ + i] = values[field];
    structure_.load(state_);
  }
  Vec3 get() {
    if (auto* spring = dynamic_cast<MassOnSpring*>(&structure_))
      return {spring->u, spring->v, spring->a};
    structure_.save(state_);
    Vec3 motion = Vec3::Zero();
    for (int field = 0; field < 3; ++field)
      for (const std::size_t i : at_)
        motion[field] += state_[field * unknowns_ + i] / static_cast<double>(at_.size());
    return motion;
  }

 private:
  fem::Structure& structure_;
  std::vector<double> state_;
  std::size_t unknowns_ = 0;
  std::vector<std::size_t> at_;
};

// One exchange of the real code on (x, v, F/m of the grain; u, v, a of the structure; the force it
// was given last and the impulse it is owed), taken from the state of balance.
inline State one_exchange(const State& s, double dt, const Exchange& e, const TwoMasses& m = {},
                          Ground ground = Ground::spring) {
  World w;
  w.exchange = e;
  set_materials(w, m.contact / .7522527780636751, 0);
  add_grain(w, dem::make_box({1, 1, 1}), 1, {0, 0, .5}, Quat::Identity(), dem::kMoveZ);
  const bool verlet = e.schedule == Schedule::both_explicit;
  std::unique_ptr<fem::Structure> owned;
  if (ground == Ground::spring)
    owned = std::make_unique<MassOnSpring>(m.mass, m.ground, 2., verlet);
  else
    owned = std::make_unique<fem::ElasticBody>(column(m, verlet));
  const double load = m.contact * kDepth;
  Top top(*owned, load);
  w.surfaces.push_back(make_surface("mass", 0, .1, 0, Vec3::Zero(), std::move(owned)));
  Surface& surface = w.surfaces[0];
  set_step(w, dt);
  const dem::StepContext c = context(dt, Vec3::Zero());
  w.bodies.applied_force[0] = Vec3(0, 0, -load);
  const double sunk = load / m.ground;
  w.bodies.x[0].z() = .5 - sunk - kDepth + s[0];
  for (int i = 0; i < surface.patch.carried; ++i) surface.patch.node[i].z() = -sunk + s[3];
  dem::StepContext still = c;
  still.dt = 0;
  prepare(w, still);
  w.bodies.v[0].z() = s[1];
  w.bodies.force[0].z() = load + s[2];
  top.put(-sunk + s[3], s[4], s[5], -(load + s[2]));
  for (int i = 0; i < 4; ++i) {
    surface.last_force[i] = Vec3(0, 0, -(load + s[2]) / 4);
    surface.given[i] = Vec3(0, 0, -(load + s[6]) / 4);
    surface.owed[i] = surface.owed_before[i] = Vec3(0, 0, -s[7] / 4);
  }
  advance(w, c, [](World&, double) {});
  double given = 0, owed = 0;
  for (int i = 0; i < 4; ++i) given -= surface.given[i].z(), owed -= surface.owed[i].z();
  const Vec3 motion = top.get();
  State next;
  next << w.bodies.x[0].z() - (.5 - sunk - kDepth), w.bodies.v[0].z(), w.bodies.force[0].z() - load,
      motion[0] + sunk, motion[1], motion[2], given - load, owed;
  return next;
}

// Per grain step at W = omega dt.
inline double growth(double W, const Exchange& e, const TwoMasses& m = {},
                     Ground ground = Ground::spring) {
  Eigen::Matrix<double, kStates, kStates> map;
  const double h = 1e-5;
  for (int k = 0; k < kStates; ++k)
    map.col(k) = (one_exchange(h * State::Unit(k), W / m.omega(), e, m, ground) -
                  one_exchange(-h * State::Unit(k), W / m.omega(), e, m, ground)) /
                 (2 * h);
  const int used = e.grain_steps > 1 ? kStates : kStates - 2;
  const double largest = Eigen::EigenSolver<Eigen::MatrixXd>(map.topLeftCorner(used, used))
                             .eigenvalues()
                             .cwiseAbs()
                             .maxCoeff();
  return std::pow(largest, 1. / e.grain_steps) - 1;
}

}  // namespace trackbed::coupling
