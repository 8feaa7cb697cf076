// What a scene leaves out is not there: bodies, loads, stages, matrices. And every effect of the
// list names the tests that show its off (tests/hard/effects_off.txt).
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "apps/trackbed/effects.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/stage.h"
#include "apps/trackbed/simulation/structures.h"

namespace trackbed::apps {
namespace {

using Changes = std::vector<std::string>;

Scene tiny(const Changes& changes = {}) { return read_scene(TINY, changes); }

const fem::ElasticBody* body_of(const std::unique_ptr<fem::Structure>& s) {
  return dynamic_cast<const fem::ElasticBody*>(s.get());
}

std::unique_ptr<fem::Structure> sleeper(const Changes& changes) {
  const Scene s = tiny(changes);
  return make_elastic_sleeper(s, make_layout(s), 0);
}
std::unique_ptr<fem::Structure> subgrade(const Changes& changes) {
  const Scene s = tiny(changes);
  return make_subgrade_structure(s, make_layout(s));
}

// Surface after some steps under forces on its nodes.
std::vector<fem::Vec> pressed(fem::Structure& s, int steps = 20) {
  s.set_step(1e-5);
  std::vector<fem::Vec> f(s.surface().nodes.size(), fem::Vec{1, 2, -30}), u, v;
  for (int k = 0; k < steps; ++k) s.advance(f);
  s.motion(u, v);
  return u;
}

TEST(EffectsOff, no_pad_is_a_pad_of_concrete) {
  const std::string same = "Sleeper/Model=elastic";
  const auto none = sleeper({same, "Sleeper/Elements=2, 2, 2"});
  EXPECT_EQ(body_of(none)->parameters().materials.size(), 1u);
  EXPECT_TRUE(body_of(none)->parameters().mesh.layers.empty());
  const Scene s = tiny();
  const auto text = [](double x) { return std::to_string(x); };
  const auto pad = sleeper({same, "Sleeper/Elements=2, 2, 1", "Sleeper/Pad thickness=0.015",
                            "Sleeper/Pad modulus=" + text(s.sleeper.modulus),
                            "Sleeper/Pad Poisson=" + text(s.sleeper.poisson),
                            "Sleeper/Pad density=" + text(s.sleeper.density)});
  EXPECT_EQ(body_of(pad)->parameters().materials.size(), 2u);
  const auto u = pressed(*none), w = pressed(*pad);
  ASSERT_EQ(u.size(), w.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    EXPECT_NEAR(u[i][2], w[i][2], 1e-10 * std::abs(u[i][2])) << i;
}

TEST(EffectsOff, no_reduction_is_the_full_body) {
  const Changes elastic{"Sleeper/Model=elastic", "Sleeper/Modes=3", "Subgrade/Modes=3"},
      more{"Sleeper/Model=elastic", "Sleeper/Modes=9", "Subgrade/Modes=9"};
  for (const auto make : {sleeper, subgrade}) {
    const auto few = make(elastic), many = make(more);
    ASSERT_TRUE(body_of(few));
    EXPECT_EQ(pressed(*few), pressed(*many));
  }
  EXPECT_FALSE(body_of(sleeper({"Sleeper/Model=elastic", "Sleeper/Reduction=modal"})));
  EXPECT_FALSE(body_of(subgrade({"Subgrade/Reduction=condensed"})));
}

TEST(EffectsOff, no_absorbing_boundary_has_no_dashpot_and_needs_no_solve) {
  const auto none = subgrade({});
  EXPECT_TRUE(body_of(none)->parameters().beds.empty());
  pressed(*none);
  EXPECT_TRUE(body_of(none)->is_explicit());
  EXPECT_EQ(none->energy().dissipated_boundary, 0);
  const auto on = subgrade({"Subgrade/Absorbing=all"});
  pressed(*on);
  EXPECT_FALSE(body_of(on)->is_explicit());
  EXPECT_GT(on->energy().dissipated_boundary, 0);
}

TEST(EffectsOff, no_damping_of_the_subgrade_has_no_constants_and_needs_no_solve) {
  const auto none = subgrade({});
  for (const fem::Material& m : body_of(none)->parameters().materials)
    EXPECT_EQ(m.rayleigh_mass + m.rayleigh_stiffness, 0);
  pressed(*none);
  EXPECT_TRUE(body_of(none)->is_explicit());
  EXPECT_EQ(none->energy().dissipated_damping, 0);
  const auto on = subgrade({"Subgrade/Damping ratio=0.05"});
  pressed(*on);
  EXPECT_FALSE(body_of(on)->is_explicit());
  EXPECT_GT(on->energy().dissipated_damping, 0);
}

TEST(EffectsOff, no_inertia_is_the_static_answer) {
  const auto off = subgrade({"Subgrade/Inertia=off"});
  const auto u = pressed(*off, 1);
  fem::ElasticBody still(body_of(off)->parameters());
  still.solve_static(std::vector<fem::Vec>(u.size(), fem::Vec{1, 2, -30}));
  std::vector<fem::Vec> w, v;
  still.motion(w, v);
  for (std::size_t i = 0; i < u.size(); ++i)
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(u[i][d], w[i][d], 1e-12 * std::abs(u[i][2])) << i;
  EXPECT_EQ(off->energy().kinetic, 0);
  EXPECT_EQ(pressed(*off, 5), u);  // it has no memory
  EXPECT_EQ(off->least_surface_mass(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(body_of(subgrade({}))->parameters().scheme == fem::TimeScheme::automatic);
}

TEST(EffectsOff, no_push_has_neither_stage_nor_load) {
  for (const auto& stage : loading_stages(tiny())) EXPECT_FALSE(stage.push) << stage.name;
  const Changes room{"Sleeper/Model=elastic", "Loading/Push=longitudinal"};
  EXPECT_EQ(sleeper({"Sleeper/Model=elastic"})->loads() + 1, sleeper(room)->loads());
  EXPECT_EQ(loading_stages(tiny()).size() + 1, loading_stages(tiny(room)).size());
}

// Off: where the load acts is where the sleeper is. On: load over stiffness farther.
TEST(EffectsOff, no_rail_pad_is_no_compression) {
  for (const double stiffness : {0., 1e10}) {
    trackbed::apps::Run run;
    run.scene = tiny({"Sleeper/Pad stiffness=" + std::to_string(stiffness)});
    run.layout = make_layout(run.scene);
    run.stage.load = 100;
    compress_pads(run, 50, 1e-5);
    EXPECT_EQ(run.stage.pad, stiffness > 0 ? 100 / stiffness : 0);
    EXPECT_EQ(run.stage.pad_work > 0, stiffness > 0);
    EXPECT_EQ(pads_energy(run) > 0, stiffness > 0);
  }
}

TEST(EffectsOff, no_symmetry_is_a_whole_box) {
  const Layout whole = make_layout(tiny()),
               half = make_layout(tiny({"Container/Half by symmetry=true"}));
  EXPECT_EQ(whole.share, 1);
  EXPECT_EQ(half.share, .5);
  EXPECT_EQ(whole.low.x(), -whole.high.x());
  EXPECT_EQ(half.low.x(), 0);
  EXPECT_NEAR(half.area, whole.area / 2, 1e-15);
  EXPECT_NEAR(half.bed_mass, whole.bed_mass / 2, 1e-12 * whole.bed_mass);
}

TEST(EffectsOff, packing_by_tamping_has_no_path_and_no_copies) {
  const Scene s = tiny();
  for (const auto& stage : packing_stages(s)) {
    EXPECT_FALSE(stage.again) << stage.name;
    EXPECT_FALSE(stage.watch) << stage.name;
    EXPECT_EQ(stage.name.find("layer"), std::string::npos) << stage.name;
  }
  const Layout sample = sample_layout(s), whole = make_layout(s);
  EXPECT_EQ(sample.low, whole.low);
  EXPECT_EQ(sample.high, whole.high);
  EXPECT_EQ(sample.bed_mass, whole.bed_mass);
}

TEST(EffectsOff, no_zones_draw_from_one_library) {
  EXPECT_EQ(make_plan(tiny(), 1).all_fine, 0);
  EXPECT_GT(make_plan(tiny({"Zones/Use=true", "Container/Length=1.6", "Container/Width=0.3",
                            "Container/Ballast depth=0.14"}),
                      1)
                .all_fine,
            0);
}

// Effect | tests that off equals the simpler model | tests that it adds nothing to a step.
TEST(EffectsOff, each_effect_names_its_tests) {
  std::string sources;
  for (const auto& file : std::filesystem::recursive_directory_iterator(TESTS))
    if (file.path().extension() == ".cc") {
      std::ifstream in(file.path());
      sources += std::string(std::istreambuf_iterator<char>(in), {});
    }
  std::map<std::string, int> listed;
  std::ifstream list(std::string(TESTS) + "/hard/effects_off.txt");
  for (std::string line; std::getline(list, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::stringstream cells(line);
    std::string effect, names;
    std::getline(cells, effect, '|');
    effect.erase(effect.find_last_not_of(' ') + 1);
    for (int column = 0; column < 2; ++column) {
      ASSERT_TRUE(std::getline(cells, names, '|')) << effect;
      std::stringstream words(names);
      int count = 0;
      for (std::string name; words >> name; ++count) {
        const auto dot = name.find('.');
        const std::string head = name.substr(0, dot) + ", " + name.substr(dot + 1) + ")";
        EXPECT_NE(sources.find("(" + head), std::string::npos) << effect << ": no test " << name;
      }
      EXPECT_GT(count, 0) << effect;
    }
    ++listed[effect];
  }
  for (const EffectKind& kind : effect_kinds())
    EXPECT_EQ(listed[kind.name], 1) << kind.name << ": one line in tests/hard/effects_off.txt";
  EXPECT_EQ(listed.size(), effect_kinds().size()) << "a line for an effect that is none";
}

}  // namespace
}  // namespace trackbed::apps
