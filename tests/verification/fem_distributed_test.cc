// The same body on any number of ranks: run by mpirun -n 1, 2, 4 against the ElasticBody of one
// process. Rank 0 runs the tests, the others serve.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "fem/distributed_body.h"
#include "fem/session.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

enum What { kSoil, kSleeper, kMultigrid, kStatic, kDamped, kBed, kCentral, kZhai, kNewmark };
// The first and the explicit schemes without a solve.
constexpr double kSteps[] = {1e-5, 4e-5, 2e-3, 1e-3, 2e-4, 1e-4, 5e-6, 5e-6, 1e-5};
bool is_explicit(int what) { return what == kSoil || what == kCentral || what == kZhai; }

// Two soils with Rayleigh constants of their own, and waves that leave through sides and bottom.
void damp(ElasticBodyParameters& p) {
  Material m = p.materials[0];
  m.name = "deep", m.young = 2e8, m.rayleigh_mass = 20, m.rayleigh_stiffness = 2e-5;
  p.materials[0].rayleigh_mass = 5;
  p.materials.push_back(m);
  p.mesh.layers = {{.2, 2, 1}, {.1, 1, 0}};
  p.supports.clear();
  for (const char* side : {"bottom", "x_min", "x_max"}) {
    Bed bed;
    bed.boundary = side, bed.absorbing = true, bed.distance = .4;
    p.beds.push_back(bed);
  }
  p.supports["y_min"] = p.supports["y_max"] = Support::roller;
}

ElasticBodyParameters parameters(int what) {
  ElasticBodyParameters p;
  p.name = "body";
  p.mesh.corner = {-.3, -.2, -.3};
  p.mesh.lengths = {.6, .4, .3};
  p.mesh.elements = {6, 4, 3};
  Material m;
  m.name = "soil", m.young = 5e7, m.poisson = .3, m.density = 2000;
  p.materials = {m};
  p.contact = {"top"};
  p.supports["bottom"] = Support::fixed;
  if (what == kSoil) p.supports["y_min"] = p.supports["y_max"] = Support::periodic;
  if (what == kSleeper) {
    p.supports.clear();
    p.order = 2;
    p.mesh.elements = {4, 2, 2};
    p.contact = {"bottom"};
    p.gravity = {0, 0, -9.81};
    Load seat;
    seat.name = "seat";
    p.loads = {seat};
    p.start_in_equilibrium = false;
  }
  if (what == kMultigrid) p.solver = SolverKind::cg_gamg;
  if (what == kStatic) p.scheme = TimeScheme::quasi_static;
  if (what == kDamped || what == kCentral || what == kZhai) damp(p);
  if (what == kCentral) p.scheme = TimeScheme::central_difference;
  if (what == kZhai) p.scheme = TimeScheme::zhai;
  if (what == kNewmark) p.scheme = TimeScheme::newmark;
  if (what == kBed) {  // a sleeper on Kelvin and Voigt's ground, in its static place at first
    p.supports.clear();
    p.gravity = {0, 0, -9.81};
    p.beds = {{"bottom", 5e7, 1e7, 3e4, 1e4}};
    p.loads = {Load{"seat"}};
  }
  return p;
}

std::vector<std::unique_ptr<Structure>> build(int what, double) {
  std::vector<std::unique_ptr<Structure>> bodies;
  bodies.push_back(std::make_unique<DistributedBody>(parameters(what)));
  return bodies;
}

// Forces that differ from node to node and from step to step.
std::vector<Vec> forces(const SurfaceMesh& mesh, int step) {
  std::vector<Vec> f;
  for (const Vec& x : mesh.nodes)
    f.push_back(
        {10 * std::sin(3 * x[0] + step), 5 * x[1], -100 * (1 + x[0]) * std::cos(.1 * step)});
  return f;
}

void expect_near(const std::vector<Vec>& a, const std::vector<Vec>& b, double share) {
  ASSERT_EQ(a.size(), b.size());
  double size = 0;
  for (const Vec& x : b)
    for (const double c : x) size = std::max(size, std::abs(c));
  EXPECT_GT(size, 0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(a[i][d], b[i][d], share * size);
}

void step(Structure& s, int first, int count) {
  if (s.loads() > 0) s.set_load(0, 500);
  for (int k = first; k < first + count; ++k) s.advance(forces(s.surface(), k));
}

class Ranks : public testing::TestWithParam<int> {};

TEST_P(Ranks, GiveTheSameAnswer) {
  const int what = GetParam();
  ElasticBody serial(parameters(what));
  ask_to_build(what, 0);
  const auto bodies = build(what, 0);
  auto& shared = static_cast<DistributedBody&>(*bodies[0]);
  ASSERT_EQ(shared.unknowns(), serial.unknowns());
  EXPECT_NEAR(shared.mass(), serial.mass(), 1e-12 * serial.mass());
  EXPECT_NEAR(1 / shared.least_surface_mass(), 1 / serial.least_surface_mass(), 1e-9);
  EXPECT_NEAR(shared.explicit_limit(), serial.explicit_limit(), 1e-3 * serial.explicit_limit());
  int all = 0;
  for (const int n : shared.rank_unknowns()) {
    EXPECT_GT(n, 0);
    all += n;
  }
  EXPECT_EQ(all, serial.unknowns());
  EXPECT_EQ(static_cast<int>(shared.rank_unknowns().size()), ranks());

  for (Structure* s : {static_cast<Structure*>(&serial), static_cast<Structure*>(&shared)}) {
    s->set_step(kSteps[what]);
    step(*s, 0, 30);
  }
  const double close = what == kMultigrid ? 1e-7 : 1e-10;
  std::vector<Vec> u, v, u1, v1;
  serial.motion(u, v), shared.motion(u1, v1);
  expect_near(u1, u, close), expect_near(v1, v, close);
  serial.predict(u, v), shared.predict(u1, v1);
  expect_near(u1, u, close), expect_near(v1, v, close);
  if (what == kSleeper) {
    EXPECT_NEAR(shared.load_displacement(0)[2], serial.load_displacement(0)[2],
                close * std::abs(serial.load_displacement(0)[2]));
  }
  if (what == kMultigrid) {
    EXPECT_GT(shared.solver_iterations(), 0);
  }
  const StructureEnergy e = serial.energy(), f = shared.energy();
  for (const auto part :
       {&StructureEnergy::kinetic, &StructureEnergy::strain, &StructureEnergy::gravity,
        &StructureEnergy::work_loads, &StructureEnergy::work_surface,
        &StructureEnergy::dissipated_damping, &StructureEnergy::dissipated_boundary})
    EXPECT_NEAR(f.*part, e.*part,
                10 * close * (1e-9 + std::abs(e.kinetic) + std::abs(e.work_surface)));
  if (what == kDamped || what == kCentral || what == kZhai) {
    EXPECT_GT(e.dissipated_damping, 0);
    EXPECT_GT(e.dissipated_boundary, 0);
    EXPECT_NE(e.dissipated_damping, e.dissipated_boundary);
  }
}

TEST_P(Ranks, GoOnFromASavedState) {
  const int what = GetParam();
  ask_to_build(what, 0);
  auto bodies = build(what, 0);
  bodies[0]->set_step(kSteps[what]);
  step(*bodies[0], 0, 5);
  std::vector<double> state, a, b;
  bodies[0]->save(state);
  step(*bodies[0], 5, 5);
  bodies[0]->save(a);
  bodies.clear();
  ask_to_build(what, 0);
  bodies = build(what, 0);
  bodies[0]->set_step(kSteps[what]);
  bodies[0]->load(state);
  step(*bodies[0], 5, 5);
  bodies[0]->save(b);
  if (ranks() == 1 || is_explicit(what)) {  // bitwise
    EXPECT_EQ(a, b);
    return;
  }
  // The solvers add over ranks in the order in which messages arrive.
  ASSERT_EQ(a.size(), b.size());
  double size = 0;
  for (const double x : a) size = std::max(size, std::abs(x));
  for (std::size_t i = 0; i < a.size(); ++i)
    EXPECT_NEAR(a[i], b[i], (what == kMultigrid ? 1e-7 : 1e-9) * size);
}

INSTANTIATE_TEST_SUITE_P(Bodies, Ranks,
                         testing::Values(kSoil, kSleeper, kMultigrid, kStatic, kDamped, kBed,
                                         kCentral, kZhai, kNewmark));

TEST(Refused, AStepOverTheLimitOfAnExplicitScheme) {
  for (const int what : {kCentral, kZhai}) {
    ElasticBody serial(parameters(what));
    ask_to_build(what, 0);
    const auto bodies = build(what, 0);
    EXPECT_NEAR(bodies[0]->largest_step(), serial.largest_step(), 1e-3 * serial.largest_step());
    EXPECT_THROW(bodies[0]->set_step(1.1 * serial.largest_step()), InputError);
  }
}

TEST(Refused, ABodyThatIsNotHeldAndStatic) {
  if (ranks() > 1) return;                         // found by all ranks together
  ElasticBodyParameters p = parameters(kSleeper);  // free
  p.scheme = TimeScheme::quasi_static;
  EXPECT_THROW(DistributedBody{p}, InputError);
}

}  // namespace

int main(int argc, char** argv) {
  start_session();
  if (rank() > 0) {
    serve(build);
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  release_ranks();
  return failed;
}
