// Knobs: what is declared fits the parameters, and ladders are what they say.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "apps/trackbed/cost/knobs.h"
#include "apps/trackbed/parameter_text.h"
#include "apps/trackbed/parameters.h"
#include "apps/trackbed/read_scene.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

const Parameter* parameter_at(const std::vector<Parameter>& table, const std::string& path) {
  for (const Parameter& p : table)
    if (parameter_path(p) == path) return &p;
  return nullptr;
}

Scene tiny(const std::vector<std::string>& set = {}) { return read_scene(TINY, set); }

std::vector<std::string> values(const std::vector<Rung>& rungs) {
  std::vector<std::string> list;
  for (const Rung& rung : rungs) list.push_back(rung.value);
  return list;
}

TEST(Knobs, EachTurnsAParameterThatThereIs) {
  const auto table = scene_parameters();
  const auto quantities = cost_quantities();
  std::set<std::string> names;
  for (const Knob& knob : all_knobs()) {
    SCOPED_TRACE(knob.name);
    EXPECT_TRUE(names.insert(knob.name).second) << "declared twice";
    const Parameter* p = parameter_at(table, knob.path);
    ASSERT_NE(p, nullptr) << knob.path;
    for (const auto& rung : knob.rungs) EXPECT_EQ(fault_of(*p, rung), "");
    EXPECT_NE(std::find(quantities.begin(), quantities.end(), knob.quantity), quantities.end());
    EXPECT_FALSE(knob.meaning.empty());
    EXPECT_TRUE(knob.rungs.size() > 1 || (knob.factor > 0 && knob.factor != 1));
    EXPECT_NO_THROW(matters_in(knob, tiny()));
  }
}

TEST(Knobs, LadderOfNumbersGoesFromCheapToExactAroundTheScenesOwn) {
  const auto rungs = ladder(knob_by_name("time_step"), tiny({"Numerics/Margin=0.2"}));
  EXPECT_EQ(values(rungs), (std::vector<std::string>{"0.8", "0.4", "0.2", "0.1", "0.05"}));
  for (std::size_t k = 0; k < rungs.size(); ++k) EXPECT_EQ(rungs[k].own, k == 2);
  EXPECT_NEAR(rungs[0].h / rungs[3].h, 8, 1e-12);
}

TEST(Knobs, CountsAreWholeAndDoNotRepeat) {
  const auto rungs = ladder(knob_by_name("sleeper_elements"), tiny({"Sleeper/Elements=1, 1, 1"}));
  EXPECT_EQ(values(rungs), (std::vector<std::string>{"1, 1, 1", "2, 2, 2"}));
  EXPECT_TRUE(rungs[0].own);
  EXPECT_NEAR(rungs[0].h / rungs[1].h, 2, 1e-12);
}

TEST(Knobs, LadderOfWordsMarksTheScenesOwn) {
  const auto rungs = ladder(knob_by_name("sieve_method"), tiny({"Grains/Sieve method=shao2017"}));
  ASSERT_EQ(rungs.size(), 6u);
  EXPECT_EQ(rungs.front().value, "equal_cube");
  EXPECT_EQ(rungs.back().value, "exact");
  EXPECT_TRUE(rungs[3].own);
}

TEST(Knobs, MatterWhereTheSceneHasWhatTheyTurn) {
  const Knob elements = knob_by_name("sleeper_elements"), soil = knob_by_name("subgrade_order");
  EXPECT_TRUE(matters_in(elements, tiny()));
  EXPECT_FALSE(matters_in(elements, tiny({"Sleeper/Model=rigid"})));
  EXPECT_TRUE(matters_in(soil, tiny()));
  EXPECT_FALSE(matters_in(soil, tiny({"Subgrade/Model=rigid"})));
}

TEST(Knobs, UnknownNameIsMetWithTheNearest) {
  try {
    knob_by_name("timestep");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("nearest: 'time_step'"), std::string::npos);
  }
}

}  // namespace
}  // namespace trackbed::apps
