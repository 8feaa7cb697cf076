// Drucker-Prager: the material point against the cone written down, its tangent against finite
// differences, and the body by Newton's iteration.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "fem/nonlinear_body.h"
#include "fem/subgrades/registry.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

constexpr double kYoung = 60e6, kNu = .3, kCohesion = 15e3, kPhi = 30, kPsi = 10;
const Values kSoil{{"Modulus", "60e6"},      {"Poisson ratio", "0.3"}, {"Cohesion", "15e3"},
                   {"Friction angle", "30"}, {"Dilation angle", "10"}, {"Density", "1900"}};

double sine(double degrees) { return std::sin(degrees * std::atan(1.) / 45); }
double cosine(double degrees) { return std::cos(degrees * std::atan(1.) / 45); }
double eta(double angle) { return 6 * sine(angle) / (std::sqrt(3.) * (3 - sine(angle))); }
double xi(double angle) { return 6 * cosine(angle) / (std::sqrt(3.) * (3 - sine(angle))); }

Values with(Values values, const char* key, const char* value) {
  values[key] = value;
  return values;
}

struct Point {
  Voigt stress;
  Tangent tangent;
  std::vector<double> history;
  double stored, dissipated;
};

Point evaluate(const StressModel& model, const Voigt& strain, std::vector<double> history = {},
               double depth = 0) {
  if (history.empty()) history.assign(model.history(), 0.);
  StressInputs in{{depth}, {strain}, history};
  StressOutputs out;
  out.stress.resize(1), out.stored.resize(1), out.dissipated.resize(1), out.tangent.resize(1);
  out.history.resize(history.size());
  out.want_tangent = true;
  model.evaluate(in, out);
  return {out.stress[0], out.tangent[0], out.history, out.stored[0], out.dissipated[0]};
}

double mean(const Voigt& s) { return (s[0] + s[1] + s[2]) / 3; }
double root_j2(const Voigt& s) {
  const double p = mean(s);
  double sum = s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
  for (int i = 0; i < 3; ++i) sum += (s[i] - p) * (s[i] - p) / 2;
  return std::sqrt(sum);
}

// Axial strain such that the sides stay free of stress change, by Newton on the lateral strain.
Point triaxial(const StressModel& model, double axial, std::vector<double> history, double& lateral,
               double cell_pressure) {
  for (int k = 0; k < 50; ++k) {
    const Point now = evaluate(model, {lateral, lateral, axial, 0, 0, 0}, history);
    const double r = now.stress[0] + cell_pressure;
    if (std::abs(r) < 1e-7) return now;
    lateral -= r / (now.tangent[0] + now.tangent[1]);
  }
  ADD_FAILURE() << "lateral strain not found";
  return {};
}

}  // namespace

// Uniaxial compression fails at 2 c cos φ/(1 − sin φ), a triaxial test at that plus
// p (1 + sin φ)/(1 − sin φ): the cone passes through Mohr and Coulomb's compressive corner.
TEST(DruckerPrager, TriaxialStrengthIsMohrCoulombs) {
  const auto model = stress_model("drucker_prager", kSoil);
  for (const double cell : {0., 50e3}) {
    std::vector<double> history(model->history(), 0.);
    double lateral = 0, axial = 0;
    // To the cell pressure first.
    const double isotropic = -cell * (1 - 2 * kNu) / kYoung;
    lateral = axial = isotropic;
    Point now = evaluate(*model, {lateral, lateral, axial, 0, 0, 0}, history);
    EXPECT_NEAR(now.stress[2], -cell, 1e-6);
    double plastic_volume = 0, plastic_axial = 0;
    for (int k = 0; k < 200; ++k) {
      axial -= 5e-5;
      now = triaxial(*model, axial, history, lateral, cell);
      history = now.history;
    }
    plastic_volume = history[0] + history[1] + history[2];
    plastic_axial = history[2];
    const double strength = 2 * kCohesion * cosine(kPhi) / (1 - sine(kPhi)) +
                            cell * (1 + sine(kPhi)) / (1 - sine(kPhi));
    EXPECT_NEAR(-now.stress[2], strength, 1e-6 * strength) << cell;
    // Flow along the gradient of √J2 + η̄ p: volume η̄, axis −1/√3 + η̄/3.
    const double axial_flow = -1 / std::sqrt(3.) + eta(kPsi) / 3;
    EXPECT_NEAR(plastic_volume / plastic_axial, eta(kPsi) / axial_flow, 1e-9);
    EXPECT_NEAR(history[6], xi(kPhi) * plastic_volume / eta(kPsi), 1e-9);
  }
}

TEST(DruckerPrager, ShearStrengthAndHardening) {
  const double H = 3e6, G = kYoung / 2.6, K = kYoung / (3 * .4);
  const auto model =
      stress_model("drucker_prager", with(with(kSoil, "Hardening", "3e6"), "Dilation angle", "30"));
  const double gamma = 5e-3;
  const Point now = evaluate(*model, {0, 0, 0, 0, 0, gamma});
  // One return in pure shear: Δγ = (Gγ − ξc)/(G + Kηη + ξ²H).
  const double e = eta(30), x = xi(30),
               slip = (G * gamma - x * kCohesion) / (G + K * e * e + x * x * H);
  EXPECT_GT(slip, 0);
  EXPECT_NEAR(now.stress[5], G * gamma - G * slip, 1e-6);
  EXPECT_NEAR(mean(now.stress), -K * e * slip, 1e-6);
  EXPECT_NEAR(root_j2(now.stress) + e * mean(now.stress), x * (kCohesion + H * x * slip), 1e-6);
}

TEST(DruckerPrager, HydrostaticTensionEndsAtTheApex) {
  const auto model = stress_model("drucker_prager", kSoil);
  const Point now = evaluate(*model, {1e-3, 1.2e-3, 1e-3, 1e-5, 0, 0});
  const double apex = kCohesion * cosine(kPhi) / sine(kPhi);  // c cot φ
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(now.stress[i], apex, 1e-6);
  EXPECT_NEAR(root_j2(now.stress), 0, 1e-9);
  // Hydrostatic compression never yields.
  const Point pressed = evaluate(*model, {-1e-2, -1e-2, -1e-2, 0, 0, 0});
  EXPECT_NEAR(pressed.stress[0], -3e-2 * kYoung / (3 * .4), 1e-3);
  EXPECT_EQ(pressed.dissipated, 0);
}

TEST(DruckerPrager, InSituStressIsThatOfTheWeight) {
  const auto model = stress_model("drucker_prager", kSoil);
  const Point now = evaluate(*model, {}, {}, 2.);
  EXPECT_NEAR(now.stress[2], -1900 * 9.81 * 2, 1e-9);
  EXPECT_NEAR(now.stress[0], -1900 * 9.81 * 2 * .3 / .7, 1e-9);
}

// Every model with history: D is d stress/d strain of the step, elastic, on the cone, at the apex.
TEST(StressModels, TangentIsConsistent) {
  int models = 0;
  for (const auto& [name, entry] : subgrade_models()) {
    if (!entry.stress) continue;
    ++models;
    const auto model = stress_model(name, {});
    std::vector<double> history = evaluate(*model, {1e-4, 0, -6e-4, 0, 2e-4, 0}, {}, .3).history;
    const Voigt strains[] = {{1e-6, -2e-6, 3e-6, 1e-6, 0, 2e-6},
                             {3e-4, 1e-4, -2e-3, 4e-4, -3e-4, 8e-4},
                             {-1e-3, -1e-3, -3e-3, 1e-3, 0, 0},
                             {2e-3, 1e-3, 2e-3, 1e-4, 0, 1e-4}};
    for (const Voigt& strain : strains) {
      const Point now = evaluate(*model, strain, history, .3);
      double size = 0;
      for (const double d : now.tangent) size = std::max(size, std::abs(d));
      for (int j = 0; j < 6; ++j) {
        const double h = 1e-8;
        Voigt up = strain, down = strain;
        up[j] += h, down[j] -= h;
        const Voigt a = evaluate(*model, up, history, .3).stress,
                    b = evaluate(*model, down, history, .3).stress;
        for (int i = 0; i < 6; ++i)
          EXPECT_NEAR((a[i] - b[i]) / (2 * h), now.tangent[6 * i + j],
                      1e-5 * std::max(size, kYoung))
              << name << " " << i << " " << j;
      }
      EXPECT_GE(now.dissipated, 0) << name;
    }
  }
  EXPECT_GT(models, 0);
}

namespace {

SubgradeSite site(double length, double width, double cell) {
  SubgradeSite s;
  s.x_low = 0, s.x_high = length, s.y_low = 0, s.y_high = width;
  s.element_size = cell;
  return s;
}

std::unique_ptr<Structure> soil(const SubgradeSite& s, Values values, NonlinearBody*& body) {
  auto made = make_subgrade("drucker_prager", s, values);
  body = dynamic_cast<NonlinearBody*>(made.get());
  return made;
}

// Even pressure on the nodes with x <= width.
std::vector<Vec> strip(const SurfaceMesh& mesh, double width, double pressure) {
  std::vector<Vec> f(mesh.nodes.size(), Vec{});
  for (const auto& quad : mesh.quads) {
    double most = 0, area = std::abs((mesh.nodes[quad[2]][0] - mesh.nodes[quad[0]][0]) *
                                     (mesh.nodes[quad[2]][1] - mesh.nodes[quad[0]][1]));
    for (const int n : quad) most = std::max(most, mesh.nodes[n][0]);
    if (most > width + 1e-9) continue;
    for (const int n : quad) f[n][2] -= pressure * area / 4;
  }
  return f;
}

}  // namespace

// In situ the soil is at rest, and a column under even load settles as one-dimensional theory says
// while it is elastic.
TEST(Body, ColumnInConfinedCompression) {
  NonlinearBody* body = nullptr;
  Values values = kSoil;

  const auto owned = soil(site(.2, .2, .1), values, body);
  body->set_step(1e-5);
  for (int k = 0; k < 5; ++k) body->advance(std::vector<Vec>(body->surface().nodes.size(), Vec{}));
  EXPECT_LT(std::abs(body->displacement_at({.1, .1, 0})[2]), 1e-12);
  body->solve_static(strip(body->surface(), 1, 20e3));
  const double oedometer = kYoung * (1 - kNu) / ((1 + kNu) * (1 - 2 * kNu));
  EXPECT_NEAR(body->displacement_at({.1, .1, 0})[2], -20e3 / oedometer, 1e-9);
  const auto stress = body->cell_stress();
  EXPECT_NEAR(stress.back()[2], -20e3 - 1900 * 9.81 * .05, 1e-3 * 20e3);
}

// Prandtl 1920: a strip on soil without friction bears (2 + π) k, k its shear strength √J2 in plane
// strain. Half by symmetry; a mesh that is too stiff bears somewhat more.
TEST(Body, StripBearsPrandtlsLoad) {
  Values values = kSoil;
  values["Friction angle"] = "0.1", values["Dilation angle"] = "0", values["Density"] = "1";
  values["Poisson ratio"] = "0.45";
  const double k = xi(.1) * kCohesion, bearing = (2 + std::acos(-1.)) * k;
  NonlinearBody* body = nullptr;
  SubgradeSite s = site(1.6, .0625, .0625);
  values["Depth"] = "0.75";
  const auto owned = soil(s, values, body);
  EXPECT_NO_THROW(body->solve_static(strip(body->surface(), .25, .97 * bearing), 8));
  EXPECT_THROW(body->solve_static(strip(body->surface(), .25, 1.1 * bearing), 4), RunError);
}

TEST(Body, NewtonConvergesQuadraticallyUnderAStrip) {
  NonlinearBody* body = nullptr;
  Values values = kSoil;
  values["Dilation angle"] = "30", values["Depth"] = "1";
  const auto owned = soil(site(2, .1, .1), values, body);
  const auto residuals = body->solve_static(strip(body->surface(), .3, 10 * kCohesion), 4);
  const double plastic = body->energy().at_start;
  EXPECT_GT(plastic, 0);
  for (const double r : residuals) std::printf("%.2e ", r);
  std::printf("\n");
  ASSERT_GE(residuals.size(), 4u);
  // Once in the basin: the exponent of the last two drops is near 2.
  const std::size_t n = residuals.size();
  std::size_t k = n - 1;
  while (k > 2 && residuals[k] < 1e-13) --k;
  const double order =
      std::log(residuals[k] / residuals[k - 1]) / std::log(residuals[k - 1] / residuals[k - 2]);
  EXPECT_GT(order, 1.6);
}

TEST(Body, MultigridGivesTheDirectAnswer) {
  NonlinearBody *direct = nullptr, *multigrid = nullptr;
  SubgradeSite s = site(1, .2, .1);
  const auto a = soil(s, with(kSoil, "Dilation angle", "5"), direct);
  s.solver = SolverKind::cg_gamg;
  const auto b = soil(s, with(kSoil, "Dilation angle", "5"), multigrid);
  for (NonlinearBody* body : {direct, multigrid})
    body->solve_static(strip(body->surface(), .2, 8 * kCohesion), 2);
  const double u = direct->displacement_at({0, 0, 0})[2];
  EXPECT_LT(u, -1e-5);
  EXPECT_NEAR(multigrid->displacement_at({0, 0, 0})[2], u, 1e-7 * std::abs(u));
}

// Unloaded soil keeps a settlement; a saved state goes on bit by bit.
TEST(Body, KeepsWhatItYieldedAndGoesOnBitByBit) {
  NonlinearBody *body = nullptr, *other = nullptr;
  const auto owned = soil(site(1, .1, .1), with(kSoil, "Depth", "0.5"), body);
  const auto again = soil(site(1, .1, .1), with(kSoil, "Depth", "0.5"), other);
  body->set_step(2e-5), other->set_step(2e-5);
  const auto none = strip(body->surface(), .2, 0);
  const auto load = strip(body->surface(), .2, 6 * kCohesion);
  for (int k = 0; k < 600; ++k) body->advance(load);
  const StructureEnergy e = body->energy();
  EXPECT_GT(e.dissipated_material, 0);
  EXPECT_LT(std::abs(e.numerical), .02 * e.work_surface);
  std::vector<double> state, a, b;
  body->save(state);
  other->load(state);
  for (int k = 0; k < 50; ++k) body->advance(none), other->advance(none);
  body->save(a), other->save(b);
  EXPECT_EQ(a, b);
  body->solve_static(none);
  EXPECT_LT(body->displacement_at({0, 0, 0})[2], -1e-5);
}

TEST(Body, ImplicitStepsFollowTheExplicitOnes) {
  NonlinearBody *fine = nullptr, *coarse = nullptr;
  const auto a = soil(site(1, .1, .1), with(kSoil, "Depth", "0.5"), fine);
  const auto b = soil(site(1, .1, .1), with(kSoil, "Depth", "0.5"), coarse);
  const double limit = fine->explicit_limit(), dt = .5 * limit;
  fine->set_step(dt), coarse->set_step(4 * dt);
  const int steps = 100;
  const auto force = [&](double t) {
    return strip(fine->surface(), .2, 8 * kCohesion * std::sin(.3927 * t / (steps * dt)));
  };
  for (int k = 1; k <= 4 * steps; ++k) fine->advance(force(k * dt));
  for (int k = 1; k <= steps; ++k) coarse->advance(force(4 * k * dt));
  const double u = fine->displacement_at({0, 0, 0})[2], v = coarse->displacement_at({0, 0, 0})[2];
  EXPECT_LT(u, -1e-5);
  EXPECT_NEAR(u, v, .03 * std::abs(u));
  EXPECT_GT(fine->energy().dissipated_material, 0);
}
