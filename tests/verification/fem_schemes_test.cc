// Time schemes and linear solvers by name, absorbing boundaries.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "fem/elastic_body.h"
#include "fem/subgrades/registry.h"
#include "fem/time_integration.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

Matrices oscillator(double k, double damping = 0) {
  Matrices m;
  m.pattern = {{0, 1}, {0}};
  m.stiffness = {k};
  m.mass = m.lumped = {1.};
  if (damping > 0) m.damping = {damping};
  return m;
}

// Largest |u| of the second half of many steps at ωΔt = W, over that of the first ten.
double growth(const Scheme& scheme, double W, double xi) {
  const Matrices m = oscillator(1, 2 * xi);
  Stepper stepper(m, scheme);
  Motion s{{1}, {0}, {-1}, {0}};
  stepper.set_step(W);
  double late = 0;
  const int steps = 20000;
  for (int n = 0; n < steps; ++n) {
    stepper.advance(s, {0.});
    if (n > steps / 2) late = std::max(late, std::abs(s.u[0]));
    if (!(std::abs(s.u[0]) < 1e30)) return 1e30;
  }
  return late;
}

// Limits are not asked of the stepper, which would refuse: what happens beyond them.
Scheme unguarded(double phi, double psi) { return zhai(phi, psi); }

}  // namespace

TEST(Zhai, SecondOrder) {
  double error[2];
  for (const int level : {0, 1}) {
    const double dt = 0.05 / (1 << level);
    const Matrices m = oscillator(1, 0.1);
    Stepper stepper(m, zhai(0.5, 0.5));
    stepper.set_step(dt);
    Motion s{{1}, {0}, {-1}, {0}};
    for (int n = 0; n < static_cast<int>(8 / dt + 0.5); ++n) stepper.advance(s, {0.});
    const double d = 0.05, w = std::sqrt(1 - d * d);
    const double exact = std::exp(-d * 8) * (std::cos(w * 8) + d / w * std::sin(w * 8));
    error[level] = std::abs(s.u[0] - exact);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.1);
}

// ωΔt of 2, 1.81, 1.64, 1.13 for damping 0, .05, .1, .3: bounded below, unstable above, and what
// the stepper says its limit is.
TEST(Zhai, StabilityLimits) {
  const double xi[] = {0, 0.05, 0.1, 0.3}, limit[] = {2, 1.81, 1.64, 1.13};
  for (int k = 0; k < 4; ++k) {
    const double exact = 2 * std::sqrt(1 + 4 * xi[k] * xi[k]) - 4 * xi[k];
    EXPECT_NEAR(exact, limit[k], 0.005);
    const Matrices m = oscillator(1, 2 * xi[k]);
    const double said = Stepper(m, zhai(0.5, 0.5)).largest_step();
    EXPECT_LT(said, exact);
    EXPECT_GT(said, 0.93 * exact);  // on the safe side
    EXPECT_LT(growth(zhai(0.5, 0.5), 0.95 * said, xi[k]), 2);
    Stepper stepper(m, zhai(0.5, 0.5));
    EXPECT_THROW(stepper.set_step(1.01 * exact), InputError);
  }
}

// φ = ψ = 0 grows at any step.
TEST(Zhai, WithoutItsCorrectionsGrows) {
  for (const double W : {0.05, 0.2, 1.}) EXPECT_GT(growth(unguarded(0, 0), W, 0), 1.5) << W;
}

TEST(CentralDifference, IsBoundedBelowItsLimitAndRefusedAbove) {
  const Matrices m = oscillator(1);
  const Scheme scheme = make_scheme(TimeScheme::central_difference, newmark());
  EXPECT_LT(growth(scheme, 0.9 * 2, 0), 3);
  Stepper stepper(m, scheme);
  EXPECT_NEAR(stepper.largest_step(), 2, 0.05);
  EXPECT_THROW(stepper.set_step(2.01), InputError);
  Matrices consistent = m;
  consistent.lumped.clear();
  EXPECT_THROW(Stepper(consistent, scheme), InputError);
}

namespace {

ElasticBodyParameters block(int n) {
  ElasticBodyParameters p;
  p.name = "block";
  p.mesh.lengths = {0.6, 0.3, 0.6};
  p.mesh.elements = {2 * n, n, 2 * n};
  p.mesh.layers = {{0.4, n, 0}, {0.2, n, 1}};
  p.materials = {{"soft", 20e6, 0.35, 1900}, {"stiff", 2e9, 0.3, 2100}};
  p.supports["bottom"] = Support::fixed;
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) p.supports[side] = Support::roller;
  p.loads = {{"plate", "top", true, 0.3, 0.15, 0.2, 0.2}};
  p.contact = {"top"};
  return p;
}

}  // namespace

// Static answer and a run of steps by every solver: the same to the iterations' tolerance; counts
// small and nearly independent of the mesh.
TEST(Solvers, GiveTheSameAnswer) {
  for (const int n : {3, 6}) {
    double reference = 0, moving = 0;
    for (const SolverKind kind :
         {SolverKind::direct, SolverKind::cg_gamg, SolverKind::cg_boomeramg}) {
      auto p = block(n);
      p.solver = kind;
      p.scheme = TimeScheme::generalised_alpha;
      ElasticBody b(p);
      b.set_load(0, 1e4);
      b.solve_static();
      const double u = b.load_displacement(0)[2];
      b.set_step(1e-3);
      b.set_load(0, 2e4);
      for (int k = 0; k < 3; ++k) b.advance(std::vector<Vec>(b.surface().nodes.size(), Vec{}));
      const double v = b.load_displacement(0)[2];
      if (kind == SolverKind::direct) {
        reference = u, moving = v;
        EXPECT_EQ(b.solver_iterations(), 0);
      } else {
        EXPECT_NEAR(u, reference, 1e-7 * std::abs(reference));
        EXPECT_NEAR(v, moving, 1e-7 * std::abs(moving));
        EXPECT_GT(b.solver_iterations(), 0);
        EXPECT_LT(b.solver_iterations(), 60);
        std::printf("%d unknowns, %s: %d iterations\n", b.unknowns(),
                    kind == SolverKind::cg_gamg ? "cg_gamg" : "cg_boomeramg",
                    b.solver_iterations());
      }
    }
  }
  EXPECT_EQ(chosen_solver(SolverKind::automatic, 1000), SolverKind::direct);
  EXPECT_EQ(chosen_solver(SolverKind::automatic, 1000000), SolverKind::cg_gamg);
}

// Every scheme comes to the same slow answer.
TEST(Schemes, AgreeWhereTheLoadIsSlow) {
  std::vector<double> answers;
  for (const char* name :
       {"newmark", "generalised_alpha", "central_difference", "zhai", "static"}) {
    auto p = block(2);
    p.materials[0].rayleigh_mass = p.materials[1].rayleigh_mass = 200;
    p.scheme = time_scheme_of(name);
    ElasticBody b(p);
    b.set_step(5e-5);
    const std::vector<Vec> none(b.surface().nodes.size(), Vec{});
    const int steps = 4000;
    std::vector<Vec> u, v, w;
    for (int n = 1; n <= steps; ++n) {
      b.set_load(0, 1e4 * (1 - std::cos(M_PI * n / steps)) / 2);
      b.predict(u, v);
      b.advance(none);
    }
    b.motion(w, v);
    if (b.is_explicit()) {
      for (std::size_t i = 0; i < u.size(); ++i)
        EXPECT_NEAR(u[i][2], w[i][2], 1e-18) << name;  // it goes where it was predicted
    }
    answers.push_back(b.load_displacement(0)[2]);
    EXPECT_EQ(b.is_explicit(),
              p.scheme == TimeScheme::central_difference || p.scheme == TimeScheme::zhai);
  }
  for (const double u : answers) EXPECT_NEAR(u, answers.back(), 5e-3 * std::abs(u));
}

TEST(Schemes, StateOfZhaiComesBackBitwise) {
  auto p = block(2);
  p.scheme = TimeScheme::zhai;
  ElasticBody one(p), two(p);
  const std::vector<Vec> none(one.surface().nodes.size(), Vec{});
  one.set_step(5e-5), two.set_step(5e-5);
  one.set_load(0, 1e4);
  for (int n = 0; n < 20; ++n) one.advance(none);
  std::vector<double> state, again;
  one.save(state);
  two.load(state);
  for (int n = 0; n < 20; ++n) one.advance(none), two.advance(none);
  one.save(state);
  two.save(again);
  EXPECT_EQ(state, again);
}

TEST(Schemes, StaticNeedsABodyThatIsHeld) {
  auto p = block(1);
  p.scheme = TimeScheme::quasi_static;
  p.supports.erase("bottom");
  try {
    ElasticBody b(p);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "block: not held: it can still move along z, so quasi_static cannot carry it; add "
                 "supports or a bed");
  }
}

// A column of soil that was pressed and let go swings in its first mode, ω = π/2 √(E/ρ)/H; each
// swing falls by the logarithmic decrement 2πξ/√(1 − ξ²).
TEST(Damping, RatioIsThatOfTheDecrement) {
  const double ratio = 0.05, omega = M_PI / 2 * std::sqrt(5e7 / 2000);
  SubgradeSite site;
  site.x_high = site.y_high = site.element_size = 0.1;
  site.newmark = true;
  site.damping = rayleigh_damping(ratio, omega, 10 * omega);
  for (const Reduction reduction : {Reduction::none, Reduction::modal}) {
    site.reduction = reduction;
    const auto soil = make_subgrade("layered_elastic", site, {{"Layers", "1:5e7:0:2000"}});
    const std::size_t nodes = soil->surface().nodes.size();
    const double dt = 2 * M_PI / omega / 200;
    soil->set_step(dt);
    std::vector<Vec> u, v, w;
    const auto swing = [&](const Vec& force, int steps) {
      for (int n = 0; n < steps; ++n) {
        soil->predict(u, w);
        soil->advance(std::vector<Vec>(nodes, force));
      }
      soil->motion(u, v);
      return u[0][2];
    };
    swing({0, 0, -100}, 20000);  // at rest under it
    swing({0, 0, 0}, 10 * 200);  // higher modes are gone by then
    double peak[2] = {};
    for (double& largest : peak)
      for (int n = 0; n < 10 * 200; ++n) {
        const double now = -swing({0, 0, 0}, 1);
        if (n < 200) largest = std::max(largest, now);
      }
    EXPECT_NEAR(std::log(peak[0] / peak[1]) / 10, 2 * M_PI * ratio / std::sqrt(1 - ratio * ratio),
                0.01 * 2 * M_PI * ratio);
  }
}

// A pulse down a confined column leaves through an absorbing boundary of its own material; one of
// another impedance r = (ρc)'/(ρc) gives ((1−r)/(1+r))² of its energy back.
TEST(AbsorbingBoundary, LetsWavesOut) {
  const double young = 1e8, rho = 2000, nu = 0.25;
  const double confined = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu)),
               c = std::sqrt(confined / rho);
  for (const double r : {1., 0.5}) {
    ElasticBodyParameters p;
    p.mesh.lengths = {0.05, 0.05, 4};
    p.mesh.elements = {1, 1, 200};
    p.materials = {{"column", young, nu, rho}};
    for (const char* side : {"x_min", "x_max", "y_min", "y_max"})
      p.supports[side] = Support::roller;
    Bed bed;
    bed.boundary = "bottom";
    if (r == 1)
      bed.absorbing = true;
    else
      bed.normal_dashpot = r * std::sqrt(rho * confined);
    p.beds = {bed};
    p.loads = {{"top", "top"}};
    p.newmark = true;
    ElasticBody b(p);
    const double dt = 0.4 * 0.02 / c, pulse = 1. / c;
    b.set_step(dt);
    double in = 0;
    for (int n = 1; n * dt < 6 / c; ++n) {
      const double t = n * dt;
      b.set_load(0, t < pulse ? 1000 * std::pow(std::sin(M_PI * t / pulse), 2) : 0.);
      b.advance({});
      if (std::abs(t - 2 / c) < dt / 2) in = b.energy().kinetic + b.energy().strain;
    }
    const auto e = b.energy();
    EXPECT_NEAR((e.kinetic + e.strain) / in, std::pow((1 - r) / (1 + r), 2), 3e-3) << r;
    EXPECT_NEAR(e.dissipated_boundary / in, 1 - std::pow((1 - r) / (1 + r), 2), 3e-3) << r;
    EXPECT_NEAR(e.dissipated_damping, 0, 1e-12 * in);
  }
}

// With springs 4/3 G/R the boundary also holds a static load: springs and column in series.
TEST(AbsorbingBoundary, SpringsHoldAStaticLoad) {
  ElasticBodyParameters p;
  p.mesh.lengths = {0.5, 0.5, 1};
  p.mesh.elements = {1, 1, 2};
  p.materials = {{"soil", 1e7, 0., 2000}};
  for (const char* side : {"x_min", "x_max", "y_min", "y_max"}) p.supports[side] = Support::roller;
  Bed bed;
  bed.boundary = "bottom";
  bed.absorbing = true;
  bed.distance = 2;
  p.beds = {bed};
  p.loads = {{"top", "top"}};
  ElasticBody b(p);
  b.set_load(0, 1e4);
  b.solve_static();
  const double shear = 1e7 / 2, exact = 1e4 / 0.25 * (2 / (4. / 3 * shear) + 1 / 1e7);
  EXPECT_NEAR(-b.load_displacement(0)[2], exact, 1e-9 * exact);
}
