// Time integration and inertia against known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "fem/elastic_body.h"
#include "fem/time_integration.h"
#include "known/reflecting_rod.h"
#include "known/resonance.h"

using namespace trackbed::fem;

namespace {

// One mass on one spring.
Matrices oscillator(double k, bool lumped = false) {
  Matrices m;
  m.pattern = {{0, 1}, {0}};
  m.stiffness = {k};
  m.mass = {1.};
  if (lumped) m.lumped = {1.};
  return m;
}

Motion start(double u, double k) { return {{u}, {0}, {-k * u}, {0}}; }

double after(Scheme scheme, double dt, double time) {
  const Matrices m = oscillator(1);
  Stepper stepper(m, scheme);
  stepper.set_step(dt);
  Motion s = start(1, 1);
  for (int n = 0; n < static_cast<int>(time / dt + 0.5); ++n) stepper.advance(s, {0.});
  return s.u[0];
}

}  // namespace

TEST(TimeIntegration, SecondOrder) {
  for (const Scheme& scheme :
       {newmark(), generalised_alpha(0.9), generalised_alpha(0.5), generalised_alpha(0)}) {
    const double coarse = std::abs(after(scheme, 0.1, 8) - std::cos(8.));
    const double fine = std::abs(after(scheme, 0.05, 8) - std::cos(8.));
    EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
  }
}

// Frequencies: numerical ω·Δt over W from many periods: Newmark ×(1−W²/12), Verlet ×(1+W²/24).
TEST(TimeIntegration, FrequencyErrors) {
  for (double W : {0.1, 0.2}) {
    for (bool is_explicit : {false, true}) {
      const Matrices m = oscillator(1, is_explicit);
      Stepper stepper(m, newmark());
      stepper.set_step(W);
      ASSERT_EQ(stepper.is_explicit(), is_explicit);
      Motion s = start(1, 1);
      double before = 1, first = 0, last = 0;
      int crossings = 0;
      for (int n = 1; n < 40000; ++n) {
        stepper.advance(s, {0.});
        if (before > 0 && s.u[0] <= 0) {  // downward crossing, by the sine through both points
          const double at = n - s.u[0] / (s.u[0] - before);
          if (!crossings++) first = at;
          last = at;
        }
        before = s.u[0];
      }
      const double ratio = 2 * M_PI * (crossings - 1) / (last - first) / W;
      const double expected = is_explicit ? 1 + W * W / 24 : 1 - W * W / 12;
      EXPECT_NEAR(ratio - 1, expected - 1, 0.03 * W * W / 12) << W << is_explicit;
    }
  }
}

// At W = 1e6 the amplitude falls by ρ_∞ a step.
TEST(TimeIntegration, DampsHighFrequencies) {
  for (double rho : {1., 0.9, 0.5, 0.2}) {
    const Matrices m = oscillator(1e12);
    Stepper stepper(m, generalised_alpha(rho));
    stepper.set_step(1);
    Motion s = start(1e-12, 1e12);
    std::vector<double> a;
    for (int n = 0; n < 60; ++n) {
      stepper.advance(s, {0.});
      a.push_back(std::hypot(s.a[0], s.u[0] * 1e12));
    }
    // A double root grows as n ρⁿ: two quotients of it give ρ.
    const double q = a[59] / a[58], expected = rho == 1 ? 1 : rho * 59. / 58;
    EXPECT_NEAR(q, expected, 0.02) << rho;
  }
}

TEST(TimeIntegration, ResonanceAmplitude) { EXPECT_NEAR(known::amplitude_at_resonance(), 1, 0.01); }

// Free–free beam 2.6 × 0.28 × 0.20 m, 40 GPa, ν 0.2, 360 kg: bending in the vertical plane.
TEST(FreeBeam, TimoshenkoFrequencies) {
  const double wanted[] = {119.87, 319.2, 597.8};
  for (int order : {1, 2}) {
    ElasticBodyParameters p;
    p.mesh.lengths = {2.6, 0.28, 0.2};
    // Order 1 needs four cells over the height for the third mode's shear to come out.
    p.mesh.elements = {order == 1 ? 52 : 26, 3, order == 1 ? 4 : 2};
    p.materials = {{"concrete", 40e9, 0.2, 360 / (2.6 * 0.28 * 0.2)}};
    p.order = order;
    const auto f = ElasticBody(p).frequencies(16);
    for (int i = 0; i < 6; ++i) EXPECT_LT(f[i], 1e-2);
    for (double hz : wanted) {
      double nearest = 1e9;
      for (double g : f) nearest = std::abs(g - hz) < std::abs(nearest - hz) ? g : nearest;
      EXPECT_NEAR(nearest, hz, 0.01 * hz) << "order " << order;
    }
  }
}

namespace {

ElasticBodyParameters column(bool newmark_scheme, Mass mass) {
  ElasticBodyParameters p;
  p.mesh.lengths = {0.2, 0.2, 1};
  p.mesh.elements = {1, 1, 20};
  p.materials = {{"rod", 1e8, 0., 2000}};
  p.supports = {{"bottom", Support::fixed}};
  p.loads = {{"top", "top"}};
  p.contact = {"top"};
  p.newmark = newmark_scheme;
  p.mass = mass;
  return p;
}

}  // namespace

// Energy ledger of a rod pushed for a while, then free: exact for Newmark, bounded for Verlet, and
// generalised-α only takes energy out.
TEST(Ledger, ClosesByScheme) {
  for (int scheme = 0; scheme < 3; ++scheme) {
    ElasticBody b(column(scheme == 0, scheme == 2 ? Mass::lumped : Mass::consistent));
    const double dt = 2e-5;
    b.set_step(dt);
    EXPECT_EQ(b.is_explicit(), scheme == 2);
    std::vector<Vec> f(4, Vec{});
    for (int n = 1; n <= 2000; ++n) {
      b.set_load(0, n < 500 ? 1000 * std::sin(n * 0.01) : 0);
      for (Vec& v : f) v[2] = n < 700 ? -100 * std::sin(n * 0.02) : 0;
      b.advance(f);
    }
    const auto e = b.energy();
    const double scale = std::abs(e.work_loads) + std::abs(e.work_surface);
    EXPECT_GT(e.kinetic + e.strain, 0.001 * scale);
    const double least[] = {-1e-11, -1e-4, -0.01}, most[] = {1e-11, 0.02, 0.01};
    EXPECT_GT(e.numerical, least[scheme] * scale);
    EXPECT_LT(e.numerical, most[scheme] * scale);
  }
}

// Explicit and implicit give the same motion to second order.
TEST(ElasticBody, ExplicitEqualsImplicitAsTheStepShrinks) {
  double difference[2];
  for (int level = 0; level < 2; ++level) {
    double u[2];
    for (bool is_explicit : {false, true}) {
      auto p = column(true, Mass::lumped);
      if (!is_explicit)
        p.beds = {{"bottom", 0, 0, 1, 1}};  // a dashpot on the fixed base: does nothing
      ElasticBody b(p);
      const int steps = 200 << level;
      b.set_step(4e-3 / steps);
      EXPECT_EQ(b.is_explicit(), is_explicit);
      for (int n = 0; n < steps; ++n) {
        const double t = 4e-3 * (n + 1) / steps;
        b.set_load(0, 1000 * std::sin(500 * t) * std::sin(500 * t));
        b.advance(std::vector<Vec>(4, Vec{}));
      }
      u[is_explicit] = b.load_displacement(0)[2];
    }
    difference[level] = std::abs(u[1] - u[0]);
    EXPECT_LT(difference[level], 0.01 * std::abs(u[0]));
  }
  EXPECT_NEAR(std::log2(difference[0] / difference[1]), 2, 0.2);
}

// Prediction error of the surface is third order in the step for an implicit body, none if
// explicit.
TEST(ElasticBody, PredictionIsWhereItGoes) {
  // How far the surface goes beside its prediction in the last of the steps to 1 ms.
  const auto miss = [](Mass mass, int steps) {
    ElasticBody b(column(true, mass));
    const double dt = 1e-3 / steps;
    b.set_step(dt);
    std::vector<Vec> f(4, Vec{}), u, v, w;
    for (int n = 1; n <= steps; ++n) {
      b.set_load(0, 1000 * std::pow(std::sin(2000 * n * dt), 2));
      b.predict(u, v);
      b.advance(f);
    }
    b.motion(w, v);
    return std::abs(u[0][2] - w[0][2]);
  };
  EXPECT_LT(miss(Mass::lumped, 100), 1e-19);  // explicit: just there
  EXPECT_NEAR(std::log2(miss(Mass::consistent, 200) / miss(Mass::consistent, 400)), 3, .2);
}

// Waves that run into a viscous boundary of impedance ratio r leave ((1−r)/(1+r))² of their energy.
TEST(ViscousBoundary, ReflectsAsTheImpedanceRatioSays) {
  for (double r : {1., 0.5, 0.2}) {
    const known::Reflection e = known::reflection(r, 200);
    EXPECT_NEAR(e.energy, std::pow((1 - r) / (1 + r), 2), 3e-3) << r;
    EXPECT_NEAR(e.numerical, 0, 1e-9);
  }
}

// What a matched boundary sends back is the mesh's dispersion: its error in speed is of second
// order, its energy of fourth.
TEST(ViscousBoundary, ReflectionOfAMatchedOneFallsWithTheMesh) {
  const double coarse = known::reflection(1, 50).energy, fine = known::reflection(1, 100).energy;
  EXPECT_GT(std::log2(coarse / fine), 3.5);
}
