// The rail pad against closed forms: springs in series, harmonic load, a load put on at once.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "fem/elastic_body.h"
#include "fem/rail_pad.h"
#include "fem/reduction.h"

namespace trackbed::fem {
namespace {

// A bar of ν = 0 on its base: L/(EA) of the seat and 1/k of the pad add up.
ElasticBodyParameters bar() {
  ElasticBodyParameters p;
  p.mesh.lengths = {0.2, 0.3, 0.5};
  p.mesh.elements = {2, 2, 3};
  p.materials = {{"bar", 2e8, 0., 1000}};
  p.supports["bottom"] = Support::fixed;
  p.loads = {{"seat", "top", true, 0.1, 0.15, 0.2, 0.3}};
  p.contact = {"top"};
  return p;
}

TEST(RailPad, SpringsInSeries) {
  const double force = 5e4, k = 1e8, exact = force * (0.5 / (2e8 * 0.06) + 1 / k);
  const double pad = pad_compression({k, 0}, 0, 0, force, 1e-4);
  ElasticBody full(bar());
  full.set_load(0, force);
  full.solve_static();
  EXPECT_NEAR(pad - full.load_displacement(0)[2], exact, 1e-9 * exact);
  const auto reduced = reduced_body(bar(), Reduction::modal, 6);
  reduced->set_load(0, force);
  reduced->solve_static();
  EXPECT_NEAR(pad - reduced->load_displacement(0)[2], exact, 1e-9 * exact);
}

// F sin ωt after many periods: |F/(k + iωc)|, late by atan(ωc/k). Second order in the step.
TEST(RailPad, HarmonicLoad) {
  const RailPad pad{1e8, 1e6};
  const double omega = 2 * M_PI * 10, force = 5e4;
  const std::complex<double> answer =
      force / std::complex<double>(pad.stiffness, omega * pad.damping);
  const auto error = [&](int steps) {  // a period
    const double dt = 2 * M_PI / omega / steps;
    double delta = 0, worst = 0;
    for (int n = 0; n < 20 * steps; ++n) {
      delta = pad_compression(pad, delta, force * std::sin(omega * n * dt),
                              force * std::sin(omega * (n + 1) * dt), dt);
      const double exact = std::imag(answer * std::polar(1., omega * (n + 1) * dt));
      if (n > 10 * steps) worst = std::max(worst, std::abs(delta - exact) / std::abs(answer));
    }
    return worst;
  };
  EXPECT_LT(error(100), 1e-3);
  EXPECT_NEAR(std::log2(error(50) / error(100)), 2, 0.05);
}

// Creeps to F/k with the time constant c/k, in steps of any length.
TEST(RailPad, LoadPutOnAtOnce) {
  const RailPad pad{1e8, 1e6};
  for (const double dt : {1e-5, 1e-3, 5e-2}) {
    double delta = 0, t = 0;
    for (int n = 0; n < 4; ++n) delta = pad_compression(pad, delta, 5e4, 5e4, dt), t += dt;
    EXPECT_NEAR(delta, 5e-4 * (1 - std::exp(-t / 1e-2)), 1e-17);
  }
  EXPECT_EQ(pad_compression({}, 0, 1, 2, 1e-3), 0);
}

// A cycle of F sin ωt loses π F² sin φ / |k + iωc| in the dashpot, tan φ = ωc/k; without one,
// nothing.
TEST(RailPad, LossOfACycle) {
  const double omega = 2 * M_PI * 10, force = 5e4, k = 1e8;
  for (const double c : {0., 1e6}) {
    const RailPad pad{k, c};
    const int steps = 2000;
    double delta = 0, lost = 0;
    for (int n = 0; n < 21 * steps; ++n) {
      const double dt = 2 * M_PI / omega / steps, before = force * std::sin(omega * n * dt),
                   now = force * std::sin(omega * (n + 1) * dt);
      const double then = pad_compression(pad, delta, before, now, dt);
      if (n >= 20 * steps)
        lost += pad_work(pad, delta, then, before, now, dt) - k * (then * then - delta * delta) / 2;
      delta = then;
    }
    const std::complex<double> stiffness(k, omega * c);
    const double exact = M_PI * force * force * std::sin(std::arg(stiffness)) / std::abs(stiffness);
    EXPECT_NEAR(lost, exact, 1e-5 * M_PI * force * force / std::abs(stiffness)) << c;
  }
}

}  // namespace
}  // namespace trackbed::fem
