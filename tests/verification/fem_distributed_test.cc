// The same body on any number of ranks: run by mpirun -n 1, 2, 4 against the ElasticBody or
// NonlinearBody of one process. Rank 0 runs the tests, the others serve.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>

#include "base/error.h"
#include "fem/distributed_body.h"
#include "fem/nonlinear_body.h"
#include "fem/session.h"
#include "fem/subgrades/registry.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

enum What {
  kSoil,
  kSleeper,
  kMultigrid,
  kStatic,
  kDamped,
  kBed,
  kCentral,
  kZhai,
  kNewmark,
  kYielding,
  kYieldingImplicit,
  kYieldingMultigrid,
  kCollapsing
};
// The first, the explicit schemes and the first that yields without a solve.
constexpr double kSteps[] = {1e-5, 4e-5, 2e-3, 1e-3, 2e-4, 1e-4, 5e-6,
                             5e-6, 1e-5, 1e-4, 1e-3, 1e-3, 1e-3};
bool is_explicit(int what) {
  return what == kSoil || what == kCentral || what == kZhai || what == kYielding;
}
bool yields(int what) { return what >= kYielding; }
// Newton's iteration takes its time; ends at 1e-10 of the forces.
int steps(int what) {
  if (what == kYieldingMultigrid) return 4;
  return yields(what) && !is_explicit(what) ? 10 : 30;
}
double tolerance(int what) {
  return what == kMultigrid || (yields(what) && !is_explicit(what)) ? 1e-7 : 1e-10;
}

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
  if (yields(what)) p.supports["y_min"] = p.supports["y_max"] = Support::roller;
  if (what == kMultigrid || what == kYieldingMultigrid) p.solver = SolverKind::cg_gamg;
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

// Its flow does not follow its yield surface: the tangent is not symmetric.
std::shared_ptr<const StressModel> soil(int what) {
  if (!yields(what)) return nullptr;
  return stress_model("drucker_prager", {{"Modulus", "5e7"},
                                         {"Density", "2000"},
                                         {"Cohesion", "10e3"},
                                         {"Dilation angle", "5"},
                                         {"Hardening", what == kCollapsing ? "0" : "1e6"}});
}

std::vector<std::unique_ptr<Structure>> build(int what, double) {
  std::vector<std::unique_ptr<Structure>> bodies;
  bodies.push_back(std::make_unique<DistributedBody>(parameters(what), soil(what)));
  return bodies;
}

std::unique_ptr<Structure> alone(int what) {
  ElasticBodyParameters p = parameters(what);
  if (!yields(what)) return std::make_unique<ElasticBody>(std::move(p));
  p.solver = SolverKind::direct;
  return std::make_unique<NonlinearBody>(std::move(p), soil(what));
}

// A strip load, raised to 150 kPa in ten steps, and most of it off again.
std::vector<Vec> strip(const SurfaceMesh& mesh, int step) {
  step = std::min(step, 18);
  std::vector<Vec> f;
  for (const Vec& x : mesh.nodes)
    f.push_back({0, 0, std::abs(x[0]) < .11 ? -150 * std::min(step, 20 - step) : 0.});
  return f;
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

void step(Structure& s, int what, int first, int count) {
  if (s.loads() > 0) s.set_load(0, 500);
  for (int k = first; k < first + count; ++k)
    s.advance(yields(what) ? strip(s.surface(), what == kYieldingMultigrid ? 3 * k : k)
                           : forces(s.surface(), k));
}

class Ranks : public testing::TestWithParam<int> {};

TEST_P(Ranks, GiveTheSameAnswer) {
  const int what = GetParam();
  const auto serial = alone(what);
  ask_to_build(what, 0);
  const auto bodies = build(what, 0);
  auto& shared = static_cast<DistributedBody&>(*bodies[0]);
  ASSERT_EQ(shared.unknowns(), serial->unknowns());
  EXPECT_NEAR(shared.mass(), serial->mass(), 1e-12 * serial->mass());
  EXPECT_NEAR(1 / shared.least_surface_mass(), 1 / serial->least_surface_mass(), 1e-9);
  EXPECT_NEAR(shared.explicit_limit(), serial->explicit_limit(), 1e-3 * serial->explicit_limit());
  int all = 0;
  for (const int n : shared.rank_unknowns()) {
    EXPECT_GT(n, 0);
    all += n;
  }
  EXPECT_EQ(all, serial->unknowns());
  EXPECT_EQ(static_cast<int>(shared.rank_unknowns().size()), ranks());
  if (yields(what)) {  // 6 x 4 x 3 cells; each has its own and some of its neighbours'
    for (const int n : shared.rank_cells()) EXPECT_TRUE(ranks() == 1 ? n == 72 : n < 72) << n;
  }

  for (Structure* s : {serial.get(), static_cast<Structure*>(&shared)}) {
    s->set_step(kSteps[what]);
    step(*s, what, 0, steps(what));
  }
  const double close = tolerance(what);
  std::vector<Vec> u, v, u1, v1;
  serial->predict(u, v), shared.predict(u1, v1);
  expect_near(u1, u, close), expect_near(v1, v, close);
  serial->motion(u, v), shared.motion(u1, v1);
  expect_near(u1, u, close), expect_near(v1, v, close);
  if (what == kYielding) {  // forces are added up in the order of the cells
    EXPECT_EQ(u1, u);
    EXPECT_EQ(v1, v);
  }
  if (what == kSleeper) {
    EXPECT_NEAR(shared.load_displacement(0)[2], serial->load_displacement(0)[2],
                close * std::abs(serial->load_displacement(0)[2]));
  }
  if (what == kMultigrid || what == kYieldingMultigrid) {
    EXPECT_GT(shared.solver_iterations(), 0);
  }
  const StructureEnergy e = serial->energy(), f = shared.energy();
  for (const auto part :
       {&StructureEnergy::kinetic, &StructureEnergy::strain, &StructureEnergy::gravity,
        &StructureEnergy::work_loads, &StructureEnergy::work_surface,
        &StructureEnergy::dissipated_damping, &StructureEnergy::dissipated_boundary,
        &StructureEnergy::dissipated_material, &StructureEnergy::numerical})
    EXPECT_NEAR(f.*part, e.*part,
                10 * close * (1e-9 + std::abs(e.kinetic) + std::abs(e.work_surface)));
  if (yields(what)) {
    EXPECT_GT(e.dissipated_material, .05 * e.work_surface);
    EXPECT_GT(e.strain, 0);
  }
  if (what == kDamped || what == kCentral || what == kZhai) {
    EXPECT_GT(e.dissipated_damping, 0);
    EXPECT_GT(e.dissipated_boundary, 0);
    EXPECT_NE(e.dissipated_damping, e.dissipated_boundary);
  }
}

TEST_P(Ranks, GoOnFromASavedState) {
  const int what = GetParam(), half = steps(what) / 2, more = std::min(5, half);
  ask_to_build(what, 0);
  auto bodies = build(what, 0);
  bodies[0]->set_step(kSteps[what]);
  step(*bodies[0], what, 0, half);
  std::vector<double> state, a, b;
  bodies[0]->save(state);
  step(*bodies[0], what, half, more);
  bodies[0]->save(a);
  bodies.clear();
  ask_to_build(what, 0);
  bodies = build(what, 0);
  bodies[0]->set_step(kSteps[what]);
  bodies[0]->load(state);
  step(*bodies[0], what, half, more);
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
    EXPECT_NEAR(a[i], b[i], std::max(1e-9, tolerance(what)) * size);
}

INSTANTIATE_TEST_SUITE_P(Bodies, Ranks,
                         testing::Values(kSoil, kSleeper, kMultigrid, kStatic, kDamped, kBed,
                                         kCentral, kZhai, kNewmark, kYielding, kYieldingImplicit,
                                         kYieldingMultigrid));

// Stresses come from the ranks that know the history.
TEST(Fields, OfSoilThatYielded) {
  const auto serial = alone(kYielding);
  ask_to_build(kYielding, 0);
  const auto bodies = build(kYielding, 0);
  const auto written = [](Structure& s) {
    const std::string run = std::to_string(::getppid());  // mpirun: the same for all ranks
    const std::string name = testing::TempDir() + "yielded_" + run + ".vtu";
    s.set_step(kSteps[kYielding]);
    step(s, kYielding, 0, 12);
    s.write_vtu(name);
    std::ifstream file(name, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    std::remove(name.c_str());
    return std::regex_replace(text, std::regex("<!--[^>]*-->"), "");  // has the date
  };
  const std::string one = written(*serial), many = written(*bodies[0]);
  EXPECT_GT(one.size(), 1000u);
  EXPECT_TRUE(one == many);
}

// All ranks meet it, rank 0 alone says it, and they go on together.
TEST(Refused, MoreLoadThanTheSoilBears) {
  ask_to_build(kCollapsing, 0);
  const auto bodies = build(kCollapsing, 0);
  Structure& body = *bodies[0];
  body.set_step(10);
  std::vector<Vec> load = strip(body.surface(), 10), u, v;
  for (Vec& f : load) f[2] *= 100;
  EXPECT_THROW(body.advance(load), RunError);
  body.motion(u, v);
  for (const Vec& x : u) EXPECT_EQ(x, (Vec{0, 0, 0}));
  body.set_step(kSteps[kCollapsing]);
  EXPECT_NO_THROW(body.advance(strip(body.surface(), 1)));
}

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

namespace {

// A user's model with an error that one rank alone meets.
class Faulty final : public StressModel {
 public:
  explicit Faulty(int faulty_rank) : faulty_rank_(faulty_rank) {}
  int history() const override { return sound_->history(); }
  double density() const override { return sound_->density(); }
  void evaluate(const StressInputs& in, StressOutputs& out) const override {
    if (rank() == faulty_rank_ && in.strain[0] != Voigt{}) throw std::runtime_error("my mistake");
    sound_->evaluate(in, out);
  }

 private:
  int faulty_rank_;
  std::shared_ptr<const StressModel> sound_ = soil(kYielding);
};

std::vector<std::unique_ptr<Structure>> build_faulty(int faulty_rank, double) {
  std::vector<std::unique_ptr<Structure>> bodies;
  bodies.push_back(std::make_unique<DistributedBody>(parameters(kYielding),
                                                     std::make_shared<Faulty>(faulty_rank)));
  return bodies;
}

// Does not come back, on any rank.
void meet_the_fault(int faulty_rank) {
  if (rank() > 0) return serve(build_faulty);
  ask_to_build(faulty_rank, 0);
  const auto bodies = build_faulty(faulty_rank, 0);
  bodies[0]->set_step(kSteps[kYielding]);
  step(*bodies[0], kYielding, 0, 30);
}

}  // namespace

// With "fault RANK": a run that an error on that rank ends.
int main(int argc, char** argv) {
  start_session();
  if (argc == 3 && argv[1] == std::string("fault")) {
    try {
      meet_the_fault(std::atoi(argv[2]));
    } catch (const std::exception&) {  // said too late: the others wait
    }
    return 0;
  }
  if (rank() > 0) {
    serve(build);
    return 0;
  }
  testing::InitGoogleTest(&argc, argv);
  const int failed = RUN_ALL_TESTS();
  release_ranks();
  return failed;
}
