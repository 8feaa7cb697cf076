// The exchange between grains and structures: growth per step of the two-mass system, momentum,
// energy, and the limit of a stiff structure.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "coupling_scene.h"

namespace trackbed::coupling {
namespace {

// Masses 1 (grain) and 2, ground spring 3 on the second, contact spring 4: a unit cube lies flat
// on the structure, pressed by a load, and moves up and down only. Face on face the contact force
// is 4 x depth to (depth/1)^4.
constexpr double kDepth = .01, kOmega = 2.56699322;
using State = Eigen::Matrix<double, 6, 1>;

// One step of the real exchange on (x, v, F/m of the grain; u, v, a of the structure), taken from
// the state of balance.
State one_step(const State& s, double dt, bool lag) {
  World w;
  set_materials(w, 4 / .7522527780636751, 0);
  add_grain(w, dem::make_box({1, 1, 1}), 1, {0, 0, .5}, Quat::Identity(), dem::kMoveZ);
  auto owned = std::make_unique<MassOnSpring>(2., 3., 2., lag);
  MassOnSpring& structure = *owned;
  w.surfaces.push_back(make_surface("mass", 0, .1, 0, Vec3::Zero(), std::move(owned)));
  structure.set_step(dt);
  const dem::StepContext c = context(dt, Vec3::Zero());
  const double load = 4 * kDepth;
  w.bodies.applied_force[0] = Vec3(0, 0, -load);
  const double sunk = load / 3;
  w.bodies.x[0].z() = .5 - sunk - kDepth + s[0];
  structure.u = -sunk + s[3];
  for (int i = 0; i < w.surfaces[0].patch.carried; ++i)
    w.surfaces[0].patch.node[i].z() = structure.u;
  dem::StepContext still = c;
  still.dt = 0;
  prepare(w, still);
  w.bodies.v[0].z() = s[1];
  w.bodies.force[0].z() = load + s[2];
  structure.v = s[4], structure.a = s[5];
  advance(w, c, [](World&, double) {});
  State next;
  next << w.bodies.x[0].z() - (.5 - sunk - kDepth), w.bodies.v[0].z(), w.bodies.force[0].z() - load,
      structure.u + sunk, structure.v, structure.a;
  return next;
}

double growth(double W, bool lag) {
  Eigen::Matrix<double, 6, 6> map;
  const double h = 1e-5;
  for (int k = 0; k < 6; ++k)
    map.col(k) = (one_step(h * State::Unit(k), W / kOmega, lag) -
                  one_step(-h * State::Unit(k), W / kOmega, lag)) /
                 (2 * h);
  return Eigen::EigenSolver<Eigen::Matrix<double, 6, 6>>(map).eigenvalues().cwiseAbs().maxCoeff() -
         1;
}

TEST(TwoMasses, growth_with_a_predicted_surface) {
  EXPECT_NEAR(growth(.1, false), 8.4e-8, .2e-8);
  EXPECT_NEAR(growth(.2, false), 1.3e-6, .05e-6);
  EXPECT_NEAR(growth(.5, false), 5e-5, .2e-5);
}

TEST(TwoMasses, a_lagged_surface_grows) { EXPECT_NEAR(growth(.1, true), 1.8e-3, .05e-3); }

struct Bounce {
  double closure, transfer, work, momentum, peak, rebound, contact_time;
};

// A cube dropped tilted on an elastic block; energies over the kinetic energy at impact.
Bounce drop(double young, double dt, bool held, double friction = 0, double modulus = 1e8,
            fem::Mass mass = fem::Mass::automatic) {
  World w;
  set_materials(w, modulus, friction);
  add_grain(w, dem::make_box({.1, .1, .1}), 2600, {.02, .01, .085},
            Quat(Eigen::AngleAxisd(.3, Vec3(.3, 1, 0).normalized())));
  fem::ElasticBodyParameters p = block(young, {.6, .6, .2}, {6, 6, 2}, held);
  p.newmark = true;
  p.mass = mass;
  auto owned = std::make_unique<fem::ElasticBody>(p);
  const fem::ElasticBody& body = *owned;
  w.surfaces.push_back(make_surface("soil", 0, .02, 0, Vec3::Zero(), std::move(owned)));
  const dem::StepContext c = context(dt, Vec3::Zero());
  w.bodies.v[0] = {.1, 0, -1};
  start(w, c);
  const auto momentum = [&]() -> Vec3 {
    const fem::Vec m = body.momentum();
    return Vec3(m[0], m[1], m[2]) + w.bodies.mass[0] * w.bodies.v[0];
  };
  const Vec3 before = momentum();
  const double kinetic = dem::kinetic_energy(w.bodies);
  Bounce b{};
  const int steps = static_cast<int>(.04 / dt + .5);
  for (int k = 0; k < steps; ++k) {
    advance(w, c, [](World&, double) {});
    const double open = closure(w.start, stores(w, c.gravity), flows(w));
    b.closure = std::max(b.closure, std::abs(open) / kinetic);
    b.transfer = std::max(b.transfer, std::abs(flows(w).transfer_error) / kinetic);
    b.peak = std::max(b.peak, w.bodies.force[0].norm());
    b.contact_time += dt * count_contacts(w);
    b.momentum = std::max(b.momentum, (momentum() - before).norm() / before.norm());
  }
  b.work = kinetic;
  b.rebound = w.bodies.v[0].z();
  return b;
}

TEST(Drop, keeps_momentum_with_a_free_body) {
  EXPECT_LT(drop(5e7, 2e-5, false, .5).momentum, 1e-12);
}

// Explicit structure: goes exactly where it was predicted to be. Implicit: the prediction errs, by
// less than the step's own error.
TEST(Drop, ledger_closes_with_the_square_of_the_step) {
  for (const auto mass : {fem::Mass::lumped, fem::Mass::consistent}) {
    const Bounce coarse = drop(5e7, 2e-5, true, 0, 1e8, mass),
                 fine = drop(5e7, 1e-5, true, 0, 1e8, mass);
    std::printf("closure %.2e %.2e, transfer %.2e %.2e\n", coarse.closure, fine.closure,
                coarse.transfer, fine.transfer);
    EXPECT_LT(coarse.closure, 1e-4);
    EXPECT_NEAR(coarse.closure / fine.closure, 4, 1.2);
    EXPECT_LT(coarse.transfer, mass == fem::Mass::lumped ? 1e-12 : 1e-6);
  }
}

TEST(Drop, ledger_closes_with_friction) { EXPECT_LT(drop(5e7, 2e-5, true, .5).closure, 1e-3); }

// Friction acts where the surface is touched, on a rigid body at the overlap's centroid, half a
// depth below: the two agree as contacts get stiff.
TEST(Drop, on_a_stiff_body_is_that_on_a_rigid_floor) {
  for (const double friction : {0., .5}) {
    const double modulus = friction > 0 ? 4e9 : 1e8, dt = friction > 0 ? 2e-6 : 1e-5;
    const Bounce stiff = drop(1e16, dt, true, friction, modulus);
    World w;
    set_materials(w, modulus, friction);
    add_grain(w, dem::make_box({.1, .1, .1}), 2600, {.02, .01, .085},
              Quat(Eigen::AngleAxisd(.3, Vec3(.3, 1, 0).normalized())));
    dem::add_box(w.bodies, w.shapes, {-.3, -.3, -.2}, {.3, .3, 0}, 0, 1, dem::kFixed);
    const dem::StepContext c = context(dt, Vec3::Zero());
    w.bodies.v[0] = {.1, 0, -1};
    start(w, c);
    double peak = 0, contact_time = 0;
    for (int k = 0; k < static_cast<int>(.04 / dt + .5); ++k) {
      advance(w, c, [](World&, double) {});
      peak = std::max(peak, w.bodies.force[0].norm());
      contact_time += dt * count_contacts(w);
    }
    EXPECT_GT(peak, 100);
    EXPECT_NEAR(stiff.peak, peak, 1e-3 * peak);
    EXPECT_NEAR(stiff.rebound, w.bodies.v[0].z(), 1e-3);
    EXPECT_NEAR(stiff.contact_time, contact_time, 1e-3 * contact_time + 2 * dt);
  }
}

// A block at rest on the elastic body: its weight reaches the support.
TEST(Rest, weight_reaches_the_ground) {
  World w;
  set_materials(w, 1e8, .5);
  const double m = 2600 * .2 * .2 * .1, g = 9.81;
  add_grain(w, dem::make_box({.2, .2, .1}), 2600, {.013, -.021, .05});
  auto owned = std::make_unique<fem::ElasticBody>(block(5e7, {.6, .6, .2}, {5, 5, 2}, true, 500));
  const fem::ElasticBody& body = *owned;
  w.surfaces.push_back(make_surface("soil", 0, .02, 0, Vec3::Zero(), std::move(owned)));
  dem::StepContext c = context(1e-4, {0, 0, -g});
  c.local_damping = .7;
  start(w, c);
  run(w, c, 8000);
  EXPECT_NEAR(w.bodies.force[0].z(), m * g, 1e-6 * m * g);
  EXPECT_NEAR(body.reaction()[2], m * g, 1e-4 * m * g);
  EXPECT_LT(w.bodies.v[0].norm(), 1e-7);
}

}  // namespace
}  // namespace trackbed::coupling
