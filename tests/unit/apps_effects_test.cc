// The table of effects against scenes, and what a scene without one leaves out of a run.
#include <gtest/gtest.h>

#include "apps/trackbed/effects.h"
#include "apps/trackbed/inertia.h"
#include "apps/trackbed/parameters.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/simulation/stage.h"
#include "fem/bending.h"

namespace trackbed::apps {
namespace {

using Changes = std::vector<std::string>;

// Room for every effect: a long bay, a short sleeper.
Scene scene(const Changes& changes) {
  Changes set{"Container/Length=1.6", "Container/Width=0.3", "Container/Ballast depth=0.14"};
  set.insert(set.end(), changes.begin(), changes.end());
  return read_scene(TINY, set);
}

bool is_on(const Scene& s, const std::string& name) {
  for (const Effect& e : effects_of(s, {}))
    if (e.name == name) return e.on;
  ADD_FAILURE() << name;
  return false;
}

TEST(Effects, EachIsSwitchedByItsKey) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.name);
    EXPECT_FALSE(is_on(scene({kind.path + "=" + kind.off}), kind.name));
    EXPECT_TRUE(is_on(scene({kind.path + "=" + kind.on}), kind.name));
    EXPECT_NE(effects_markdown().find("| " + kind.name + " | " + kind.path), std::string::npos);
  }
}

TEST(Effects, StagesAndLayoutWithoutThem) {
  const Scene without = scene({"Packing/Plate cycles=0", "Contact/Packing damping=0"});
  for (const Stage& stage : packing_stages(without)) {
    EXPECT_NE(stage.name, "tamping");
    EXPECT_EQ(stage.damping, 0) << stage.name;
  }
  EXPECT_EQ(packing_stages(scene({})).size(), packing_stages(without).size() + 1);
  EXPECT_EQ(loading_stages(without).back().damping, 0);
  trackbed::apps::Run run;
  run.layout = make_layout(without);
  EXPECT_EQ(step_context(run, loading_stages(without).back()).period, dem::Vec3::Zero());
  // A shoulder of no width is a box filled to its walls.
  EXPECT_EQ(make_layout(scene({"Container/Shoulder slope=0.5"})).bed_mass,
            make_layout(scene({})).bed_mass);
}

TEST(Auto, SleeperBendsWhereItIsLongForItsBed) {
  const Scene block = scene({"Sleeper/Model=auto"});
  EXPECT_EQ(block.sleeper.model, "rigid");
  ASSERT_EQ(block.decisions.size(), 1u);
  EXPECT_NE(block.decisions[0].find("rigid"), std::string::npos);
  const Scene sleeper = scene({"Sleeper/Model=auto", "Container/Length=4", "Sleeper/Length=2.6",
                               "Sleeper/Height=0.2", "Sleeper/Width=0.28"});
  EXPECT_EQ(sleeper.sleeper.model, "elastic");
  EXPECT_TRUE(is_on(sleeper, "elastic sleeper"));
  EXPECT_TRUE(scene({"Sleeper/Model=elastic"}).decisions.empty());
}

// A triangle's harmonics 1, 3, 5 … have amplitudes 1/n²; two of them carry 99 % of its power. Two
// cosines of powers 1 and 0.04: the second counts.
TEST(Auto, HighestHarmonicOfTheLoad) {
  LoadingScene l{};
  l.frequency = 10;
  for (const auto& [waveform, harmonic] :
       {std::pair{"sine", 1}, {"haversine", 1}, {"triangle", 3}}) {
    l.waveform = waveform;
    EXPECT_NEAR(highest_harmonic(l), 10 * harmonic, 1e-12) << waveform;
  }
  l.waveform = "table";
  l.history = {{0, .05, .1}, {0, 1, 0}};
  EXPECT_NEAR(highest_harmonic(l), 30, 1e-12);
  l.history = {};
  for (int k = 0; k <= 200; ++k) {
    const double t = k / 200.;
    l.history.time.push_back(.1 * t);
    l.history.load.push_back(5 - std::cos(2 * M_PI * t) + .2 * std::cos(14 * M_PI * t));
  }
  EXPECT_NEAR(highest_harmonic(l), 70, 1e-12);
}

// A column of 0.4 m that cannot spread: c_p² = E(1−ν)/((1+ν)(1−2ν)ρ) = 206.18² (m/s)², f = c_p/4H =
// 128.87 Hz; slow below 32.2 Hz.
TEST(Auto, InertiaWhereTheLoadNearsTheFirstMode) {
  const auto column = [](const std::string& hertz, const Changes& more = {}) {
    Changes set{"Subgrade/layered_elastic/Layers=0.4:6e7:0.3:1900", "Subgrade/Inertia=auto",
                "Loading/Frequency=" + hertz};
    set.insert(set.end(), more.begin(), more.end());
    return read_scene(TINY, set);
  };
  EXPECT_NEAR(first_mode_of_subgrade(column("10")), 128.87, .005 * 128.87);
  const Scene slow = column("31.8"), quick = column("32.6");
  EXPECT_EQ(slow.subgrade.inertia, "off");
  EXPECT_EQ(slow.numerics.exchange, "iterated");
  EXPECT_FALSE(is_on(slow, "inertia of the subgrade"));
  ASSERT_EQ(slow.decisions.size(), 2u);
  EXPECT_NE(slow.decisions[0].find("31.8 Hz"), std::string::npos);
  EXPECT_EQ(quick.subgrade.inertia, "on");
  EXPECT_EQ(quick.numerics.exchange, "predicted");
  EXPECT_EQ(quick.decisions.size(), 1u);
  EXPECT_EQ(column("12", {"Loading/Waveform=triangle"}).subgrade.inertia, "on");  // its third
  EXPECT_EQ(column("1", {"Subgrade/Model=winkler"}).subgrade.inertia, "on");
  EXPECT_NEAR(1 / (1 - kSlowLoad * kSlowLoad) - 1, .067, 5e-4);
}

// A sleeper as a beam: L 2.6, EI 5e6, k 5e7: λ = (5e7/2e7)^(1/4) = 1.257433.
TEST(Auto, LengthRatio) {
  EXPECT_NEAR(fem::beam_length_ratio(5e7, 5e6, 2.6), 2.6 * 1.2574334296829355, 1e-12);
  // Twelfth root of one: Vesic's k is 0.65 E/(1−ν²).
  EXPECT_NEAR(fem::vesic_bed(1e8, 0.5, 1, 1e8), 0.65 * 1e8 / 0.75, 1e-6);
}

}  // namespace
}  // namespace trackbed::apps
