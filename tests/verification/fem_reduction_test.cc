// Reduced bodies against the full one and against known answers.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "fem/reduction.h"
#include "known/reduced_response.h"

using namespace trackbed::fem;
using namespace trackbed::fem::known;

TEST(Reduction, FollowsTheFullBody) {
  EXPECT_LT(deviation(sleeper(), Reduction::modal, 20).error, 0.01);
  EXPECT_LT(deviation(soil(), Reduction::condensed, 80).error, 0.006);
}

// A ladder: more modes, less error, down to the dents that no mode has.
TEST(Reduction, ErrorFallsWithTheModes) {
  double before = 1;
  for (const int modes : {5, 20, 80}) {
    const double error = deviation(soil(), Reduction::condensed, modes).error;
    EXPECT_LT(error, 0.7 * before) << modes;
    before = error;
  }
}

TEST(Reduction, ReportsItsError) {
  const ReductionReport modal = *reduced_body(sleeper(), Reduction::modal, 20)->model().report;
  const ReductionReport condensed = *reduced_body(soil(), Reduction::condensed, 5)->model().report;
  for (const auto& r : {modal, condensed}) {
    EXPECT_EQ(r.frequencies.size(), 5);
    EXPECT_LT(r.largest_frequency_error, 1e-6);
    EXPECT_NEAR(r.pressure_error, 0, 1e-6);
  }
  EXPECT_LT(modal.modes, 60);
  EXPECT_GT(modal.node_error, 0.01);  // the dent under one node takes high modes
  EXPECT_NEAR(condensed.node_error, 0, 1e-6);
}

// Static deflections of a held body, under loads that the basis has been given.
TEST(Reduction, StaticsAreTheFullBodys) {
  auto p = soil();
  p.loads = {{"plate", "top", true, 0.3, 0.15, 0.2, 0.2}};
  ElasticBody full(p);
  full.set_load(0, 1e4);
  full.solve_static();
  for (const Reduction r : {Reduction::modal, Reduction::condensed}) {
    const auto reduced = reduced_body(p, r, 10);
    reduced->set_load(0, 1e4);
    reduced->solve_static();
    EXPECT_NEAR(reduced->load_displacement(0)[2] / full.load_displacement(0)[2], 1, 1e-8);
    EXPECT_NEAR(reduced->energy().strain / full.energy().strain, 1, 1e-8);
  }
}

// A sleeper on uneven ground, together as stiff as a bed of ballast (some 80 kN/mm): springs under
// half of its base's nodes, up to twenty times each other. What it bends then, and the bending
// moment by statics from the springs' and the seats' forces.
struct OnSprings {
  double middle, seat;    // deflection [m]
  double least, largest;  // moment [N m]
};

OnSprings on_springs(const ModalStructure& body, unsigned seed) {
  const ModalModel& m = body.model();
  const int n = body.modes();
  const Eigen::Map<const Eigen::MatrixXd> turned(m.shape.data(), n, m.shape.size() / n);  // Φᵀ
  std::mt19937 random(seed);
  const auto uniform = [&] { return random() / 4294967296.; };
  std::vector<std::pair<int, double>> springs;  // node, stiffness
  for (std::size_t i = 0; i < m.surface.nodes.size(); ++i)
    if (m.surface.nodes[i][2] == 0 && uniform() < .5)
      springs.emplace_back(static_cast<int>(i), 3e5 * std::pow(20, uniform()));
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
  for (int k = 0; k < n; ++k) A(k, k) = m.omega[k] * m.omega[k];
  for (const auto& [node, stiffness] : springs)
    for (int d = 0; d < 3; ++d) {
      const Eigen::VectorXd shape = turned.col(3 * node + d);
      A += (d == 2 ? 1 : .5) * stiffness * shape * shape.transpose();
    }
  Eigen::VectorXd f = Eigen::VectorXd::Zero(n);
  const double seat = 62.5e3;
  for (const ModalLoad& load : m.loads)
    f -= seat * Eigen::Map<const Eigen::VectorXd>(&load.shape[2 * n], n);
  const Eigen::VectorXd q = A.ldlt().solve(f);
  OnSprings result{0, 0, 0, 0};
  const auto deflection = [&](double x) {
    double best = HUGE_VAL, u = 0;
    for (std::size_t i = 0; i < m.surface.nodes.size(); ++i) {
      const Vec& at = m.surface.nodes[i];
      const double far = std::abs(at[0] - x) + std::abs(at[1]) + std::abs(at[2]);
      if (far < best) best = far, u = -turned.col(3 * i + 2).dot(q);
    }
    return u;
  };
  result.middle = deflection(0), result.seat = deflection(-.75);
  for (double x = -1.3; x < 1.3; x += .05) {
    double moment = 0;
    for (const auto& [node, stiffness] : springs)
      if (const double arm = m.surface.nodes[node][0] - x; arm > 0)
        moment -= stiffness * turned.col(3 * node + 2).dot(q) * arm;
    for (const double at : {-.75, .75}) {
      const double low = std::max(x, at - .075), high = at + .075;
      if (high > low) moment -= seat * (high - low) / .15 * (.5 * (low + high) - x);
    }
    result.least = std::min(result.least, moment),
    result.largest = std::max(result.largest, moment);
  }
  return result;
}

// What the modes of the scenes leave out (dents of single nodes) against all static answers of the
// surface, which are the full body's (StaticsAreTheFullBodys). The least moment may be next to
// nothing, so it is measured by the largest. On ground thirty times as stiff the dents count: 10 %
// of its deflection, 1 % of the largest moment.
TEST(Reduction, BendsOnUnevenGroundAsTheFullBody) {
  const auto modal = reduced_body(sleeper(), Reduction::modal, 20);
  const auto full = reduced_body(sleeper(), Reduction::condensed, 20);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const OnSprings a = on_springs(*modal, seed), b = on_springs(*full, seed);
    EXPECT_NEAR(a.middle / b.middle, 1, 0.005) << seed;
    EXPECT_NEAR(a.seat / b.seat, 1, 0.005) << seed;
    EXPECT_NEAR(a.largest / b.largest, 1, 0.002) << seed;
    EXPECT_NEAR(a.least, b.least, 0.002 * b.largest) << seed;
  }
}

TEST(Reduction, FreeBodyFallsAtGAndKeepsMomentum) {
  auto p = sleeper();
  p.gravity = {0, 0, -9.81};
  p.start_in_equilibrium = false;
  const auto b = reduced_body(p, Reduction::modal, 20);
  EXPECT_NEAR(b->mass(), 360, 1e-9);
  b->set_step(1e-4);
  const std::vector<Vec> none(b->surface().nodes.size(), Vec{});
  for (int n = 0; n < 1000; ++n) b->advance(none);
  std::vector<Vec> u, v;
  b->motion(u, v);
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_NEAR(u[i][2], -0.5 * 9.81 * 0.01, 1e-9);
    EXPECT_NEAR(v[i][2], -9.81 * 0.1, 1e-8);
  }
  // A push on one node and a seat: the impulse is the body's momentum, whatever it does inside.
  const auto momentum = [&] {
    std::vector<double> state;
    b->save(state);
    double sum = 0;  // the weight's modal force is -9.81 times the modes' share of the mass
    for (int k = 0; k < b->modes(); ++k)
      sum += b->model().gravity[k] / -9.81 * state[4 + b->modes() + k];
    return sum;
  };
  auto push = none;
  push[3] = {50, -20, 700};
  b->set_load(0, 300);
  const double before = momentum();
  b->advance(push);  // half a step of it, then whole ones, then half a step
  for (int n = 1; n < 100; ++n) b->advance(push);
  b->set_load(0, 0);
  b->advance(none);
  EXPECT_NEAR(momentum() - before, 400 * 0.01 - 9.81 * 360 * 101e-4, 1e-9 * 360 * 9.81);
}

TEST(Reduction, RefusesWhatItCannot) {
  auto p = soil();
  p.beds = {{"bottom", 0, 0, 1e5, 1e5}};
  try {
    reduced_body(p, Reduction::modal, 10);
    FAIL();
  } catch (const std::exception& e) {
    EXPECT_STREQ(e.what(),
                 "Subgrade: dashpots on boundary 'bottom' couple the modes; a reduced body cannot "
                 "have them, reduction none can");
  }
  EXPECT_THROW(
      {
        auto b = reduced_body(sleeper(), Reduction::modal, 5);
        b->set_load(0, 1);
        b->solve_static();
      },
      std::exception);
}

namespace {

// One mode that carries one node.
ModalModel oscillator(double omega, double mass, double damping = 0) {
  ModalModel m;
  m.surface.nodes = {{0, 0, 0}};
  m.surface.same_as = {0};
  m.omega = {omega};
  m.damping_mass = damping;
  m.shape = {0, 0, 1 / std::sqrt(mass)};
  m.mass = m.least_surface_mass = mass;
  return m;
}

}  // namespace

// A constant force: u = F/k (1 − e^{−δt}(cos ω_d t + δ/ω_d sin ω_d t)), at steps of any size below
// ωΔt = 1; beyond, the static deflection is still exact.
TEST(ModalStructure, IsExactUnderAConstantForce) {
  const double omega = 7, mass = 2, force = 3;
  for (const double delta : {0., 0.4, 8.})
    for (const double dt : {0.01, 0.14}) {
      ModalStructure s(oscillator(omega, mass, 2 * delta));
      s.set_step(dt);
      s.advance({{0, 0, force}});
      // The first step has half of the force from its end on: from there on it is constant.
      std::vector<Vec> u, v;
      s.motion(u, v);
      const double q0 = u[0][2] - force / (mass * omega * omega), v0 = v[0][2];
      for (int n = 0; n < 50; ++n) s.advance({{0, 0, force}});
      s.motion(u, v);
      const double t = 50 * dt, r2 = omega * omega - delta * delta, r = std::sqrt(std::abs(r2));
      const double c = r2 > 0 ? std::cos(r * t) : std::cosh(r * t),
                   sine = (r2 > 0 ? std::sin(r * t) : std::sinh(r * t)) / r;
      const double exact = force / (mass * omega * omega) +
                           std::exp(-delta * t) * (q0 * (c + delta * sine) + v0 * sine);
      EXPECT_NEAR(u[0][2], exact, 1e-13) << delta << " " << dt;
    }
  ModalStructure stiff(oscillator(1e6, mass, 0));
  stiff.set_step(0.1);
  double mean = 0;
  std::vector<Vec> u, v;
  for (int n = 0; n < 6283; ++n) {
    stiff.advance({{0, 0, force}});
    stiff.motion(u, v);
    mean += u[0][2] / 6283;
  }
  EXPECT_NEAR(mean * mass * 1e12 / force, 1, 1e-2);
}

// Two masses on springs: masses 1 (grain, velocity Verlet) and 2, ground spring 3 on the second,
// contact spring
// 4. No growth at any step: the energy after many steps is bounded.
TEST(ModalStructure, TwoMassesDoNotGrow) {
  for (const double W : {0.1, 0.5, 1.}) {
    const double dt = W / 2.56699322;
    ModalStructure s(oscillator(std::sqrt(1.5), 2));
    s.set_step(dt);
    std::vector<Vec> u, w;
    double x = 0.01, v = 0, f = -4 * x, early = 0, late = 0;
    s.advance({{0, 0, 0}});
    const int steps = 200000;
    for (int n = 0; n < steps; ++n) {
      x += dt * (v + dt / 2 * f);
      s.predict(u, w);
      const double now = -4 * (x - u[0][2]);
      s.advance({{0, 0, -now}});
      v += dt / 2 * (f + now);
      f = now;
      std::vector<Vec> place;
      s.motion(place, w);
      EXPECT_EQ(place[0][2], u[0][2]);  // it goes where it was predicted
      double& most = n < steps / 10 ? early : late;
      if (n < steps / 10 || n > steps * 9 / 10) most = std::max(most, std::abs(x));
    }
    EXPECT_NEAR(late / early, 1, 1e-3) << W;
  }
}

TEST(ModalStructure, EnergyAndStateComeBack) {
  auto p = soil();
  const auto one = reduced_body(p, Reduction::modal, 10),
             two = reduced_body(p, Reduction::modal, 10);
  one->set_step(2e-5), two->set_step(2e-5);
  for (int n = 0; n < 100; ++n) one->advance(forces(one->surface().nodes.size(), n * 1e-3));
  std::vector<double> state, again;
  one->save(state);
  two->load(state);
  for (auto* s : {one.get(), two.get()})
    for (int n = 0; n < 100; ++n) s->advance(forces(s->surface().nodes.size(), n * 1e-4));
  one->save(state);
  two->save(again);
  EXPECT_EQ(state, again);
  const StructureEnergy e = one->energy();
  EXPECT_GT(e.work_surface, 0);
  EXPECT_NEAR(e.numerical, 0, 1e-3 * e.work_surface);
  state.pop_back();
  EXPECT_THROW(two->load(state), std::exception);
}
