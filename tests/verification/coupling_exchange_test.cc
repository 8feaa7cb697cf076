// The exchange between grains and structures: growth per step of the two-mass system, momentum,
// energy, and the limit of a stiff structure.
#include <gtest/gtest.h>

#include "coupling_scene.h"
#include "two_masses.h"

namespace trackbed::coupling {
namespace {

TEST(TwoMasses, growth_with_a_predicted_surface) {
  EXPECT_NEAR(growth(.1, exchange("predicted")), 8.4e-8, .2e-8);
  EXPECT_NEAR(growth(.2, exchange("predicted")), 1.3e-6, .05e-6);
  EXPECT_NEAR(growth(.5, exchange("predicted")), 5e-5, .2e-5);
}

// At a share of 2/omega of each mass with twice the spring, on any ground: a third is what
// coupling/time_step.h allows, a half would be too much.
TEST(TwoMasses, grow_little_at_the_largest_step_on_any_ground) {
  const auto worst = [](double share) {
    double most = 0;
    for (const double mass : {.5, 1., 2., 5.})
      for (double ground = .1; ground < 2000; ground *= 1.5) {
        const TwoMasses m{mass, ground, 4};
        const double dt = share * 2 / std::sqrt(2 * m.contact / std::min(1., mass));
        most = std::max(most, growth(dt * m.omega(), exchange("predicted"), m));
      }
    return most;
  };
  EXPECT_LT(worst(1. / 3), 1e-3);
  EXPECT_GT(worst(1. / 2), 3e-3);
  EXPECT_LT(worst(1. / 2), 5e-3);
}

TEST(TwoMasses, no_growth_explicit_or_iterated) {
  for (const char* name : {"explicit", "iterated"})
    for (const double W : {.1, .5}) EXPECT_NEAR(growth(W, exchange(name)), 0, 1e-9) << name << W;
}

TEST(TwoMasses, a_lagged_surface_grows) {
  EXPECT_NEAR(growth(.1, exchange("lagged")), 1.8e-3, .05e-3);
}

TEST(TwoMasses, growth_has_the_order_of_its_schedule) {
  const auto order = [](const char* name) {
    return std::log2(growth(.2, exchange(name)) / growth(.1, exchange(name)));
  };
  EXPECT_NEAR(order("predicted"), 4, .05);
  EXPECT_NEAR(order("lagged"), 2, .1);
}

// Eigenvalues of the 9 x 9 map of this schedule, written down by hand and solved elsewhere.
TEST(TwoMasses, several_steps_are_damped_up_to_the_limit) {
  const std::pair<int, double> expected[] = {
      {2, 7.0e-8}, {5, -4.3e-6}, {10, -9.4e-5}, {20, -1.8e-3}};
  for (const auto& [n, value] : expected)
    EXPECT_NEAR(growth(.1, exchange("several_steps", n)), value, .03 * std::abs(value)) << n;
  EXPECT_NEAR(growth(.1, exchange("several_steps", 30)), 1.6e-2, .05e-2);
}

TEST(TwoMasses, one_of_several_steps_is_the_default) {
  const State s = 1e-3 * State::Ones();
  EXPECT_EQ(one_exchange(s, .05, exchange("several_steps")),
            one_exchange(s, .05, exchange("predicted")));
}

// A column of one element is the same mass on the same spring.
TEST(TwoMasses, on_finite_elements_grow_as_on_a_spring) {
  for (const Exchange& e : {exchange("predicted"), exchange("lagged"), exchange("explicit"),
                            exchange("several_steps", 2), exchange("several_steps", 10)})
    for (const double W : {.1, .5})
      EXPECT_NEAR(growth(W, e, {}, Ground::element), growth(W, e), 1e-8)
          << static_cast<int>(e.schedule) << ' ' << e.grain_steps << ' ' << W;
}

struct Bounce {
  double closure, transfer, work, momentum, owed, peak, rebound, contact_time;
  long iterations;
};

// A cube dropped tilted on an elastic block; energies over the kinetic energy at impact.
Bounce drop(double young, double dt, bool held, double friction = 0, double modulus = 1e8,
            fem::Mass mass = fem::Mass::automatic, const Exchange& e = {}) {
  World w;
  w.exchange = e;
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
  const auto owed = [&]() -> Vec3 {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : w.surfaces[0].owed) sum += p;
    return sum;
  };
  const auto momentum = [&]() -> Vec3 {
    const fem::Vec m = body.momentum();
    return Vec3(m[0], m[1], m[2]) + w.bodies.mass[0] * w.bodies.v[0] + owed();
  };
  const Vec3 before = momentum();
  const double kinetic = dem::kinetic_energy(w.bodies);
  Bounce b{};
  const int exchanges = static_cast<int>(.04 / dt / e.grain_steps + .5);
  for (int k = 0; k < exchanges; ++k) {
    advance(w, c, [](World&, double) {});
    const double open = closure(w.start, stores(w, c.gravity), flows(w));
    b.closure = std::max(b.closure, std::abs(open) / kinetic);
    b.transfer = std::max(b.transfer, std::abs(flows(w).transfer_error) / kinetic);
    b.peak = std::max(b.peak, w.bodies.force[0].norm());
    b.contact_time += e.grain_steps * dt * count_contacts(w);
    b.momentum = std::max(b.momentum, (momentum() - before).norm() / before.norm());
  }
  b.work = kinetic;
  b.rebound = w.bodies.v[0].z();
  w.bodies.x[0].z() += 1;  // taken away
  if (e.grain_steps > 1) run(w, c, 50);
  b.momentum = std::max(b.momentum, (momentum() - before).norm() / before.norm());
  b.owed = owed().norm() / before.norm();
  b.iterations = w.times.iterations;
  return b;
}

const Exchange kSchedules[] = {exchange("predicted"),        exchange("explicit"),
                               exchange("several_steps", 2), exchange("several_steps", 10),
                               exchange("iterated"),         exchange("lagged")};

// What the grains give, the structure gets: at each exchange, what it is owed counted, and all of
// it once the grain has left.
TEST(Drop, keeps_momentum_with_a_free_body) {
  for (const Exchange& e : kSchedules) {
    const bool lumped = e.schedule == Schedule::both_explicit;
    const Bounce b =
        drop(5e7, 2e-5, false, .5, 1e8, lumped ? fem::Mass::lumped : fem::Mass::automatic, e);
    const std::string name = schedules()[static_cast<int>(e.schedule)].name;
    std::printf("%-14s %2d: momentum %.1e, owed at the end %.1e, closure %.1e, transfer %.1e\n",
                name.c_str(), e.grain_steps, b.momentum, b.owed, b.closure, b.transfer);
    EXPECT_LT(b.momentum, 1e-12) << name;
    EXPECT_LT(b.owed, 1e-12) << name;
    EXPECT_LT(b.closure, 1e-3) << name;
  }
}

// The exchange's own error falls with the step, and is nothing where place and force agree.
TEST(Drop, transfer_error_of_each_schedule) {
  const auto transfer = [](const Exchange& e, double dt) {
    return drop(5e7, dt, true, 0, 1e8, fem::Mass::consistent, e).transfer;
  };
  EXPECT_LT(transfer(exchange("iterated"), 2e-5), 1e-12);
  EXPECT_GT(transfer(exchange("lagged"), 2e-5), 5e-4);
  const double five = transfer(exchange("several_steps", 5), 2e-5),
               half = transfer(exchange("several_steps", 5), 1e-5);
  EXPECT_LT(five, 1e-4);
  EXPECT_GT(five / half, 3);
}

TEST(Exchange, bad_choices_are_refused) {
  EXPECT_THROW(schedule_named("sometimes"), InputError);
  World w = bed(2, 1);  // lumped: goes explicitly up to its limit
  w.exchange = exchange("explicit");
  const double limit = w.surfaces[0].structure->explicit_limit();
  EXPECT_GT(limit, 0);
  set_step(w, .9 * limit);
  try {
    set_step(w, 1.1 * limit);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("would do"), std::string::npos) << e.what();
  }
}

TEST(Exchange, that_does_not_converge_stops_the_run) {
  Exchange e = exchange("iterated");
  e.most_iterations = 2;
  EXPECT_THROW(drop(5e5, 2e-4, true, 0, 1e8, fem::Mass::consistent, e), RunError);
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
    for (const char* name : {"predicted", "iterated", "several_steps"}) {
      if (friction > 0 && std::string(name) != "predicted") continue;
      const Exchange e = exchange(name, std::string(name) == "several_steps" ? 5 : 1);
      const Bounce stiff = drop(1e16, dt, true, friction, modulus, fem::Mass::automatic, e);
      EXPECT_NEAR(stiff.peak, peak, 1e-3 * peak) << name;
      EXPECT_NEAR(stiff.rebound, w.bodies.v[0].z(), 1e-3) << name;
      EXPECT_NEAR(stiff.contact_time, contact_time, 1e-3 * contact_time + 2 * e.grain_steps * dt)
          << name;
    }
  }
}

// A cube pressed slowly on an elastic block: without inertia the surface is the static answer to
// the forces it is given, and the moving block's comes within (f/f1)² of it, f1 = 350 Hz or more
// (a column of 0.1 m held at its base, free to spread: c = √(E/ρ)).
TEST(SlowLoad, static_surface_is_the_limit_of_the_moving_one) {
  const double period = .05, dt = 1e-4;
  const auto deepest = [&](bool is_static) {
    World w;
    w.exchange = exchange(is_static ? "iterated" : "predicted");
    w.exchange.tolerance = 1e-8;
    set_materials(w, 1e8, 0);
    add_grain(w, dem::make_box({.1, .1, .1}), 2600, {0, 0, .05}, Quat::Identity(), dem::kMoveZ);
    fem::ElasticBodyParameters p = block(5e7, {.2, .2, .1}, {4, 4, 2});
    if (is_static) p.scheme = fem::TimeScheme::quasi_static;
    auto owned = std::make_unique<fem::ElasticBody>(p);
    const fem::ElasticBody& body = *owned;
    w.surfaces.push_back(make_surface("soil", 0, .02, 0, Vec3::Zero(), std::move(owned)));
    const dem::StepContext c = context(dt, Vec3::Zero());
    start(w, c);
    double lowest = 0;
    std::vector<fem::Vec> u, v, still, f;
    for (int k = 1; k <= std::lround(period / dt); ++k) {
      advance(w, c, [&](World& world, double t) {
        world.bodies.applied_force[0].z() = -500 * (1 - std::cos(2 * M_PI * t / period));
      });
      body.motion(u, v);
      for (const auto& x : u) lowest = std::min(lowest, x[2]);
      if (is_static && k % 100 == 0) {
        const Surface& s = w.surfaces[0];
        fem::ElasticBody other(p);
        other.solve_static(s.forces);
        other.motion(still, v);
        for (std::size_t i = 0; i < u.size(); ++i)
          EXPECT_NEAR(u[i][2], still[i][2], 1e-12 * std::abs(lowest));
      }
    }
    EXPECT_LT(std::abs(closure(w.start, stores(w, c.gravity), flows(w))),
              1e-3 * flows(w).work + 1e-6);
    return lowest;
  };
  const double still = deepest(true), moving = deepest(false);
  EXPECT_LT(still, -1e-6);
  EXPECT_NEAR(moving / still, 1, .02);
}

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
