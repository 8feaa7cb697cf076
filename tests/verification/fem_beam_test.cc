// The Timoshenko beam sleeper against closed solutions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/beam.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

BeamParameters sleeper() {
  BeamParameters p;
  p.low_x = -1.3, p.high_x = 1.3;
  p.width = 0.28, p.height = 0.2;
  p.elements = 26;
  p.young = 40e9, p.poisson = 0.2, p.density = 360 / (2.6 * 0.28 * 0.2);
  return p;
}

// Displacement of the surface node nearest to (x, y, z).
Vec at(const ModalStructure& s, const Vec& point) {
  std::vector<Vec> u, v;
  s.motion(u, v);
  const auto& nodes = s.surface().nodes;
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double sum = 0;
    for (int d = 0; d < 3; ++d) sum += std::pow(nodes[i][d] - point[d], 2);
    if (sum < least) least = sum, best = i;
  }
  EXPECT_LT(least, 1e-12);
  return u[best];
}

}  // namespace

// Free beam on Winkler's bed under a centre load (Hetényi 1946), thin beam.
TEST(Beam, OnWinklerFoundation) {
  auto p = sleeper();
  p.bending = 5e6;
  p.shear_rigid = true;
  p.bed = 5e7;
  p.loads = {{"centre", 0, 0, {0, 0, -1}}};
  double error[2];
  for (const int level : {0, 1}) {
    p.elements = 26 << level;
    const auto b = make_beam(p);
    b->set_load(0, 1e5);
    b->solve_static();
    EXPECT_NEAR(-at(*b, {0, 0, 0})[2], 1.370944e-3, 1e-3 * 1.370944e-3);
    EXPECT_NEAR(-at(*b, {1.3, 0, 0})[2], -6.571674e-5, 1e-3 * 6.571674e-5);
    const double moment = b->gauge(p.elements / 2);
    EXPECT_NEAR(moment, 2.165161e4, 3e-3 * 2.165161e4);
    error[level] = std::abs(moment - 2.165161e4);
    EXPECT_NEAR(-b->load_displacement(0)[2], 1.370944e-3, 1e-3 * 1.370944e-3);
  }
  EXPECT_NEAR(error[1], 0, 1e-3 * 2.165161e4);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2, 0.3);  // the bed's pressure within an element
}

// Free-free vertical bending of a concrete sleeper by Timoshenko's beam.
TEST(Beam, FreeFrequencies) {
  const auto b = make_beam(sleeper());
  std::vector<double> hz;
  for (const double w : b->model().omega) hz.push_back(w / (2 * M_PI));
  EXPECT_EQ(std::count(hz.begin(), hz.end(), 0.), 6);
  for (const double wanted : {119.87, 319.2, 597.8}) {
    double nearest = 1e9;
    for (const double f : hz)
      if (std::abs(f - wanted) < std::abs(nearest - wanted)) nearest = f;
    EXPECT_NEAR(nearest, wanted, 0.01 * wanted);
  }
}

// Half of it with a plane of symmetry has the symmetric ones of them.
TEST(Beam, HalfBySymmetry) {
  auto p = sleeper();
  p.low_x = 0, p.elements = 13, p.half = true;
  const auto half = make_beam(p);
  const auto whole = make_beam(sleeper());
  const auto nearest = [](const std::vector<double>& all, double f) {
    double best = 1e9;
    for (const double w : all)
      if (std::abs(w - f) < std::abs(best - f)) best = w;
    return best;
  };
  EXPECT_EQ(std::count(half->model().omega.begin(), half->model().omega.end(), 0.), 3);
  int shared = 0;
  for (const double w : half->model().omega) {
    if (w == 0 || w > 5000) continue;
    EXPECT_NEAR(nearest(whole->model().omega, w), w, 1e-6 * w);
    ++shared;
  }
  EXPECT_GE(shared, 3);
  EXPECT_NEAR(half->mass(), 180, 1e-9);
}

// Two loads on a beam held by a stiff bed at rest, Timoshenko's shear: three points bending is
// P L³/48EI + P L/4κGA between the ends; here a free beam with opposite forces in balance.
TEST(Beam, ThreePointBendingWithShear) {
  auto p = sleeper();
  p.bed = 1e-3;  // holds it against round-off
  p.loads = {
      {"left", -1.3, 0, {0, 0, 1}}, {"middle", 0, 0, {0, 0, -1}}, {"right", 1.3, 0, {0, 0, 1}}};
  const auto b = make_beam(p);
  b->set_load(0, 500), b->set_load(1, 1000), b->set_load(2, 500);
  b->solve_static();
  const double EI = 40e9 * 0.28 * 0.008 / 12, GA = 5. / 6 * 40e9 / 2.4 * 0.056, L = 2.6;
  const double exact = 1000 * (L * L * L / (48 * EI) + L / (4 * GA));
  const double bent = b->load_displacement(0)[2] - b->load_displacement(1)[2];
  EXPECT_NEAR(bent, exact, 1e-6 * exact);
  EXPECT_NEAR(b->gauge(13), 1000 * L / 4, 1e-5 * 1000 * L / 4);
}

// The surface turns with the line: a rigid turn of a free beam moves every node by θ × r, and the
// forces on the surface keep resultant and moment.
TEST(Beam, SurfaceMovesRigidly) {
  auto p = sleeper();
  p.gravity = {0, 0, -9.81};
  p.base = 0.3;
  const auto b = make_beam(p);
  b->set_step(1e-5);
  const std::size_t n = b->surface().nodes.size();
  const std::vector<Vec> none(n, Vec{});
  for (int k = 0; k < 100; ++k) b->advance(none);
  std::vector<Vec> u, v;
  b->motion(u, v);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_NEAR(v[i][2], -9.81e-3, 1e-12);
    EXPECT_NEAR(v[i][0], 0, 1e-12);
  }
  // Two forces that make a couple about z: no mean motion, ω = couple t / I of a slender box.
  auto couple = none;
  std::size_t left = 0, right = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec& x = b->surface().nodes[i];
    if (std::abs(x[1]) < 1e-9 && std::abs(x[2] - 0.3) < 1e-9) {
      if (x[0] < b->surface().nodes[left][0] - 1e-9 || left == 0) left = i;
      if (x[0] > b->surface().nodes[right][0] + 1e-9) right = i;
    }
  }
  couple[left] = {0, -10, 0}, couple[right] = {0, 10, 0};
  const int steps = 20000;  // long against its vibrations
  for (int k = 0; k < steps; ++k) b->advance(couple);
  b->motion(u, v);
  const double inertia = 360 * (2.6 * 2.6 + 0.28 * 0.28) / 12, turn = 0.5 * 26 / inertia * 0.04;
  EXPECT_NEAR((u[right][1] - u[left][1]) / 2.6, turn, 2e-3 * turn);
}

TEST(Beam, RefusesBadInput) {
  const auto why = [](const BeamParameters& p) -> std::string {
    try {
      make_beam(p);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  auto p = sleeper();
  p.poisson = 0.5;
  EXPECT_EQ(why(p), "Sleeper: Poisson's ratio 0.5, must lie between -1 and 0.5");
  p = sleeper();
  p.young = 0;
  EXPECT_EQ(why(p), "Sleeper: Young's modulus 0 Pa, must be positive");
  p = sleeper();
  p.loads = {{"seat", 1.29, 0.15, {0, 0, -1}}};
  EXPECT_NE(why(p).find("'seat' at x = 1.29 m, 0.15 m long, sticks out"), std::string::npos);
  p = sleeper();
  p.loads = {{"centre", 0, 0, {0, 0, -1}}};
  const auto b = make_beam(p);
  b->set_load(0, 1);
  EXPECT_THROW(b->solve_static(), InputError);
}
