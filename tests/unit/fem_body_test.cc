// The elastic body's surface, loads, supports and refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>

#include "base/error.h"
#include "fem/elastic_body.h"
#include "tests/scratch_folder.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

ElasticBodyParameters block(int order = 1) {
  ElasticBodyParameters p;
  p.name = "Sleeper";
  p.mesh.corner = {-0.5, -0.2, 1.};
  p.mesh.lengths = {1., 0.4, 0.3};
  p.mesh.elements = {4, 3, 2};
  p.materials = {{"concrete", 30e9, 0.2, 2400}};
  p.order = order;
  p.contact = {"bottom", "x_max"};
  return p;
}

Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// The refusal's text: one line that holds all the given words.
void expect_refusal(const std::function<void()>& act, const std::vector<std::string>& words) {
  try {
    act();
    FAIL() << "accepted";
  } catch (const InputError& e) {
    const std::string text = e.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    for (const auto& word : words) EXPECT_NE(text.find(word), std::string::npos) << text;
  }
}

class Orders : public testing::TestWithParam<int> {};

}  // namespace

TEST_P(Orders, SurfaceFacesOutwardsAndClosesAtEdges) {
  const ElasticBody body(block(GetParam()));
  const SurfaceMesh& s = body.surface();
  const int m = GetParam();
  ASSERT_EQ(s.quads.size(), static_cast<std::size_t>((4 * 3 + 3 * 2) * m * m));
  double area = 0;
  int border = 0;
  for (std::size_t q = 0; q < s.quads.size(); ++q) {
    const auto& k = s.quads[q];
    const Vec n = cross(minus(s.nodes[k[2]], s.nodes[k[0]]), minus(s.nodes[k[3]], s.nodes[k[1]]));
    area += std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
    if (s.boundary[q] == 0) {
      EXPECT_LT(n[2], 0);
    }
    if (s.boundary[q] == 1) {
      EXPECT_GT(n[0], 0);
    }
    for (Edge e : s.edges[q]) {
      border += e == Edge::border;
      EXPECT_NE(e, Edge::seam);
    }
  }
  EXPECT_NEAR(area, 1. * 0.4 + 0.4 * 0.3, 1e-12);
  // bottom: two long sides and one end; end: two sides and the upper edge
  EXPECT_EQ(border, (4 + 4 + 3 + 2 + 2 + 3) * m);
}

TEST_P(Orders, SurfaceForcesKeepResultantAndMoment) {
  // A free body: momentum gained over one step of constant force is force times time, and the
  // centre of mass moves as if all force acted there.
  auto p = block(GetParam());
  p.newmark = true;
  ElasticBody body(p);
  body.set_step(1e-4);
  const auto& s = body.surface();
  std::vector<Vec> f(s.nodes.size());
  Vec sum{};
  for (std::size_t i = 0; i < f.size(); ++i)
    for (int d = 0; d < 3; ++d) sum[d] += f[i][d] = std::sin(1. + 3. * i + d) * 100;
  body.advance(f);
  body.advance(f);
  const Vec momentum = body.momentum();
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(momentum[d], sum[d] * 1.5e-4, 1e-12 * 1500);
}

INSTANTIATE_TEST_SUITE_P(Elements, Orders, testing::Values(1, 2));

TEST(ElasticBody, PeriodicSeamIsNoBorder) {
  auto p = block();
  p.contact = {"top"};
  p.supports = {
      {"y_min", Support::periodic}, {"y_max", Support::periodic}, {"bottom", Support::fixed}};
  ElasticBody body(p);
  const auto& s = body.surface();
  EXPECT_DOUBLE_EQ(s.period[1], 0.4);
  EXPECT_EQ(s.period[0], 0);
  int seams = 0, borders = 0, images = 0;
  for (const auto& edges : s.edges)
    for (Edge e : edges) seams += e == Edge::seam, borders += e == Edge::border;
  for (std::size_t i = 0; i < s.nodes.size(); ++i) images += s.same_as[i] != static_cast<int>(i);
  EXPECT_EQ(seams, 8);
  EXPECT_EQ(borders, 6);
  EXPECT_EQ(images, 5);
  // A force on the image is a force on the node itself, and both move alike.
  body.set_step(1e-5);
  std::vector<Vec> f(s.nodes.size(), Vec{}), u, v;
  for (std::size_t i = 0; i < f.size(); ++i)
    if (s.same_as[i] != static_cast<int>(i)) f[i] = {0, 0, -1000};
  body.advance(f);
  body.motion(u, v);
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_EQ(u[i], u[s.same_as[i]]);
}

TEST(ElasticBody, FreeBodyFallsAtG) {
  auto p = block();
  p.gravity = {0, 0, -9.81};
  ElasticBody body(p);
  const double dt = 1e-3;
  body.set_step(dt);
  std::vector<Vec> u, v, f(body.surface().nodes.size(), Vec{});
  body.predict(u, v);
  for (const Vec& w : v) EXPECT_NEAR(w[2], -9.81 * dt, 1e-10 * dt);
  for (int n = 0; n < 10; ++n) body.advance(f);
  body.motion(u, v);
  for (const Vec& w : u) EXPECT_NEAR(w[2], -9.81 * 50 * dt * dt, 1e-10);
  EXPECT_NEAR(body.mass(), 2400 * 0.12, 1e-10);
  const auto e = body.energy();
  EXPECT_NEAR(e.numerical, 0, 1e-9 * e.kinetic);
}

TEST(ElasticBody, RailSeatLoadIsExact) {
  // The seat cuts through cells; the reaction's moments about two axes are those of its centre.
  for (int order : {1, 2}) {
    auto p = block(order);
    p.supports = {{"bottom", Support::fixed}};
    p.loads = {{"left", "top", true, -0.27, 0.03, 0.21, 0.17}, {"all", "top"}};
    ElasticBody body(p);
    body.set_load(0, 1000);
    body.solve_static();
    EXPECT_NEAR(body.reaction()[2], 1000, 1e-8);
    EXPECT_LT(body.load_displacement(0)[2], 0);
    body.set_load(1, 500);
    body.solve_static();
    EXPECT_NEAR(body.reaction()[2], 1500, 1e-8);
    // energy of a linear body: ½ Σ F u
    const double work =
        0.5 * (-1000 * body.load_displacement(0)[2] - 500 * body.load_displacement(1)[2]);
    EXPECT_NEAR(body.energy().strain, work, 1e-10 * work);
  }
}

class Solvers : public testing::TestWithParam<SolverKind> {};

// What iterates must start from the same place, damped or not, whether or not it was stopped.
TEST_P(Solvers, StateComesBackBitwise) {
  auto p = block();
  p.solver = GetParam();
  p.scheme = TimeScheme::generalised_alpha;
  p.supports = {{"top", Support::fixed}};
  p.materials[0].rayleigh_stiffness = 1e-6;
  p.loads = {{"push", "x_min"}};
  p.loads[0].direction = {1, 0, 0};
  const auto drive = [](ElasticBody& body, int from, int to) {
    std::vector<Vec> f(body.surface().nodes.size());
    for (int n = from; n < to; ++n) {
      body.set_step(n % 3 ? 1e-5 : 5e-6);
      for (std::size_t i = 0; i < f.size(); ++i)
        f[i] = {std::sin(n + 0.1 * i), 1, std::cos(n + 0.2 * i)};
      body.set_load(0, 100 * std::sin(0.3 * n));
      body.advance(f);
    }
  };
  ElasticBody whole(p), first(p), second(p);
  drive(whole, 0, 40);
  drive(first, 0, 17);
  std::vector<double> state, a, b;
  first.save(state);
  second.load(state);
  drive(second, 17, 40);
  whole.save(a);
  second.save(b);
  EXPECT_EQ(a, b);
  state.pop_back();
  expect_refusal([&] { second.load(state); }, {"Sleeper", "saved state"});
}

INSTANTIATE_TEST_SUITE_P(ElasticBody, Solvers,
                         testing::Values(SolverKind::direct, SolverKind::cg_gamg));

TEST(ElasticBody, MovesWithTranslation) {
  ElasticBody body(block());
  const Vec before = body.surface().nodes[3];
  body.translate({1, 2, 3});
  const Vec after = body.surface().nodes[3];
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(after[d] - before[d], 1 + d, 1e-12);
}

TEST(ElasticBody, WritesFieldsForParaView) {
  for (int order : {1, 2}) {
    auto p = block(order);
    const ScratchFolder folder;
    ElasticBody body(p);
    body.write_vtu(folder.file("fem_body.vtu"));
    std::ifstream in(folder.file("fem_body.vtu"));
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    for (const char* word :
         {"displacement_m", "velocity_m_per_s", "von_mises_Pa", "stress_zz_Pa", "material"})
      EXPECT_NE(text.find(word), std::string::npos) << word;
    EXPECT_FALSE(std::ifstream(folder.file("fem_body.vtu.part")).good());
    write_pvd(folder.file("fem_body.pvd"), {{0., "fem_body.vtu"}});
    EXPECT_TRUE(std::ifstream(folder.file("fem_body.pvd")).good());
    EXPECT_THROW(body.write_vtu(folder.file("no_such_folder/x.vtu")), RunError);
  }
}

TEST(ElasticBodyRefuses, BadMaterials) {
  const auto with = [](auto change) {
    return [change] {
      auto p = block();
      change(p.materials[0]);
      ElasticBody body(p);
    };
  };
  expect_refusal(with([](Material& m) { m.poisson = 0.5; }),
                 {"Sleeper", "concrete", "Poisson", "0.5"});
  expect_refusal(with([](Material& m) { m.young = 0; }), {"concrete", "Young", "positive"});
  expect_refusal(with([](Material& m) { m.young = kMustBeSet; }), {"concrete", "Young"});
  expect_refusal(with([](Material& m) { m.density = -1; }), {"concrete", "density", "positive"});
  expect_refusal(with([](Material& m) { m.rayleigh_mass = -1; }), {"concrete", "Rayleigh"});
}

TEST(ElasticBodyRefuses, BadBoundariesAndLoads) {
  const auto with = [](auto change) {
    return [change] {
      auto p = block();
      change(p);
      ElasticBody body(p);
    };
  };
  using P = ElasticBodyParameters;
  expect_refusal(with([](P& p) { p.supports["under"] = Support::fixed; }),
                 {"Sleeper", "'under'", "bottom", "x_min"});
  expect_refusal(with([](P& p) { p.contact = {"sole"}; }), {"contact", "'sole'", "bottom"});
  expect_refusal(with([](P& p) { p.supports["x_min"] = Support::periodic; }), {"x_min", "x_max"});
  expect_refusal(with([](P& p) { p.supports["top"] = Support::periodic; }), {"top", "x_min"});
  expect_refusal(with([](P& p) {
                   p.loads = {{"seat", "top", true, 0.5, 0, 0.2, 0.2}};
                 }),
                 {"seat", "sticks out", "top"});
  expect_refusal(with([](P& p) {
                   p.loads = {{"seat", "top", true, 0, 0, 0, 0.2}};
                 }),
                 {"seat", "positive"});
  expect_refusal(with([](P& p) { p.mesh.lengths[1] = 0; }), {"length", "y", "positive"});
  expect_refusal(with([](P& p) { p.mesh.elements[0] = 0; }), {"elements", "x"});
  expect_refusal(with([](P& p) { p.mesh.layers = {{0.1, 1, 3}}; }), {"material 3"});
  expect_refusal(with([](P& p) { p.order = 3; }), {"order 3", "1 and 2"});
  expect_refusal(with([](P& p) { p.rho_inf = 1.2; }), {"rho_inf", "0 to 1"});
  expect_refusal(with([](P& p) { p.mesh.file = "no_such.msh"; }), {"no_such.msh", "opened"});
}

TEST(ElasticBodyRefuses, StaticsOfABodyThatIsNotHeld) {
  const auto with = [](std::map<std::string, Support> supports) {
    return [supports] {
      auto p = block();
      p.supports = supports;
      ElasticBody body(p);
      body.solve_static();
    };
  };
  const auto roller = Support::roller, periodic = Support::periodic;
  expect_refusal(with({}), {"Sleeper", "not held"});
  expect_refusal(with({{"bottom", roller}}), {"not held", "move along x"});
  expect_refusal(with({{"bottom", roller}, {"x_min", roller}}), {"not held", "move along y"});
  expect_refusal(with({{"y_min", periodic}, {"y_max", periodic}}), {"not held", "move along x"});
  EXPECT_NO_THROW(with({{"bottom", roller}, {"x_min", roller}, {"y_min", roller}})());
  EXPECT_NO_THROW(with({{"y_min", Support::fixed}})());
}

TEST(ElasticBodyRefuses, MeshFilesThatDoNotFit) {
  const ScratchFolder folder;
  const std::string file = folder.file("cell.msh");
  const auto write = [&](bool twisted, const char* name) {
    std::ofstream out(file);
    out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 7 \"" << name
        << "\"\n3 9 \"steel\"\n$EndPhysicalNames\n$Nodes\n8\n"
        << "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n";
    out << (twisted ? "7 .1 .1 .1\n" : "7 1 1 1\n") << "8 0 1 1\n$EndNodes\n$Elements\n2\n"
        << "1 3 2 7 1 1 4 3 2\n2 5 2 9 1 1 2 3 4 5 6 7 8\n$EndElements\n";
  };
  auto p = block();
  p.mesh = {};
  p.mesh.file = file;
  p.contact = {"sole"};
  write(false, "sole");
  EXPECT_EQ(ElasticBody(p).surface().quads.size(), 1u);
  p.mesh.region_material = {{"steel", 0}};
  EXPECT_EQ(ElasticBody(p).surface().quads.size(), 1u);
  p.mesh.region_material = {{"wood", 0}};
  expect_refusal([&] { ElasticBody body(p); }, {file, "steel", "wood"});
  p.mesh.region_material = {};
  write(false, "other");
  expect_refusal([&] { ElasticBody body(p); }, {"Sleeper", "'sole'", "other"});
  write(true, "sole");
  expect_refusal([&] { ElasticBody body(p); }, {file, "inverted"});
  std::ofstream(file) << "nonsense";
  expect_refusal([&] { ElasticBody body(p); }, {file, "Gmsh"});
}
