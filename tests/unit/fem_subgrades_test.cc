// Every file in fem/subgrades is a model that can be chosen by name; bad values are refused.
#include <gtest/gtest.h>

#include <filesystem>

#include "base/error.h"
#include "fem/subgrades/registry.h"

using namespace trackbed;
using namespace trackbed::fem;

namespace {

SubgradeSite site() {
  SubgradeSite s;
  s.x_low = -0.3, s.x_high = 0.3, s.y_high = 0.3;
  s.element_size = 0.15;
  return s;
}

std::string refusal(const std::string& model, const Values& values,
                    const SubgradeSite& where = site()) {
  try {
    make_subgrade(model, where, values);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

}  // namespace

TEST(Subgrades, EveryFileIsInTheRegistry) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TRACKBED_SUBGRADES)) {
    const auto name = entry.path().stem().string();
    if (entry.path().extension() != ".cc" || name == "registry") continue;
    EXPECT_TRUE(subgrade_models().count(name)) << name;
    ++files;
  }
  EXPECT_EQ(static_cast<int>(subgrade_models().size()), files);
}

TEST(Subgrades, AreDocumentedAndStandWithTheirDefaults) {
  for (const auto& [name, model] : subgrade_models()) {
    EXPECT_GT(model.documentation.size(), 40u) << name;
    for (const Parameter& p : model.parameters) {
      EXPECT_FALSE(p.unit.empty()) << name << p.key;
      EXPECT_FALSE(p.meaning.empty()) << name << p.key;
    }
    const auto structure = make_subgrade(name, site(), {});
    for (const Vec& x : structure->surface().nodes) EXPECT_NEAR(x[2], 0, 1e-12);
    structure->set_step(1e-4);
    std::vector<Vec> f(structure->surface().nodes.size(), Vec{0, 0, -10}), u, v;
    for (int n = 0; n < 10; ++n) structure->advance(f);
    structure->motion(u, v);
    for (const Vec& w : u) EXPECT_LT(w[2], 0) << name;
  }
}

TEST(Subgrades, RefuseWithTheNamesThereAre) {
  EXPECT_NE(refusal("layered", {}).find("layered_elastic"), std::string::npos);
  EXPECT_NE(refusal("depth_elastic", {{"Deep", "1"}}).find("Depth"), std::string::npos);
  EXPECT_NE(refusal("depth_elastic", {{"Depth", "-1"}}).find("allowed"), std::string::npos);
  EXPECT_NE(refusal("depth_elastic", {{"Depth", "1 m"}}).find("not a number"), std::string::npos);
  EXPECT_NE(refusal("depth_elastic", {{"Poisson ratio", "0.5"}}).find("0.4999"), std::string::npos);
  EXPECT_NE(refusal("layered_elastic", {{"Layers", "0.2:1e6"}}).find("thickness:E:nu:density"),
            std::string::npos);
  EXPECT_NE(refusal("layered_elastic", {{"Layers", "0.2:1e6:0.5:1900"}}).find("Poisson"),
            std::string::npos);
}

TEST(Subgrades, DampElasticMaterialsOnly) {
  SubgradeSite damped = site();
  damped.damping = rayleigh_damping(0.05, 60, 600);
  EXPECT_EQ(refusal("layered_elastic", {}, damped), "accepted");
  EXPECT_EQ(refusal("depth_elastic", {}, damped), "accepted");
  EXPECT_NE(refusal("winkler", {}, damped).find("kelvin_voigt"), std::string::npos);
  EXPECT_NE(refusal("drucker_prager", {}, damped).find("Damping ratio"), std::string::npos);
}

TEST(PointBed, ComesToRestAtForceOverStiffness) {
  auto s = site();
  s.periodic_y = true;
  const auto bed = make_subgrade("kelvin_voigt", s, {{"Dashpot", "1e6"}});
  const SurfaceMesh& mesh = bed->surface();
  EXPECT_DOUBLE_EQ(mesh.period[1], 0.3);
  bed->set_step(1e-3);
  std::vector<Vec> f(mesh.nodes.size(), Vec{}), u, v;
  for (const auto& q : mesh.quads)  // 1e5 Pa
    for (int node : q) f[node][2] -= 1e5 * 0.15 * 0.15 / 4;
  for (int n = 0; n < 4000; ++n) bed->advance(f);
  bed->motion(u, v);
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_NEAR(u[i][2], -1e-3, 1e-12);
    EXPECT_EQ(u[i], u[mesh.same_as[i]]);
  }
  const auto e = bed->energy();
  EXPECT_NEAR(e.strain, 0.5 * 1e5 * 1e-3 * 0.18, 1e-9);
  EXPECT_NEAR(e.work_surface, e.strain + e.dissipated_damping + e.numerical, 1e-12);
  std::vector<double> state, again;
  bed->save(state);
  const auto other = make_subgrade("kelvin_voigt", s, {{"Dashpot", "1e6"}});
  other->load(state);
  other->set_step(1e-3);
  bed->advance(f);
  other->advance(f);
  bed->save(state);
  other->save(again);
  EXPECT_EQ(state, again);
}
