// From text to a checked scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "apps/trackbed/choices.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/freedom.h"
#include "apps/trackbed/parameter_text.h"
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/parameters.h"
#include "apps/trackbed/plan.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/scene_text.h"
#include "apps/trackbed/simulation/structures.h"
#include "apps/trackbed/waveform.h"
#include "base/error.h"
#include "dem/motion/bodies.h"
#include "fem/subgrades/registry.h"
#include "tests/scratch_folder.h"

namespace trackbed::apps {
namespace {

// A model as a user would add it: this is all of it.
const fem::RegisterSubgrade here{
    {"my_bed",
     "Independent springs of a stiffness given as settlement under a pressure of 100 kPa.",
     {{"Subgrade/my_bed",
       "Settlement",
       "1e-3",
       "m",
       "under 100 kPa",
       ParameterKind::number,
       1e-9,
       1,
       {}}},
     [](const fem::SubgradeSite& site, const fem::Values& values) {
       fem::PointBedParameters p = fem::points_under(site);
       p.stiffness = 1e5 / fem::number(values, "Settlement");
       p.mass = 400;
       return fem::make_point_bed(p);
     }}};

class Parameters : public testing::Test, public ScratchFolder {};

TEST(ParameterTable, EveryDefaultIsAllowed) {
  std::set<std::string> paths;
  for (const auto& p : scene_parameters()) {
    EXPECT_EQ(fault_of(p, p.fallback), "") << parameter_path(p);
    EXPECT_FALSE(p.meaning.empty()) << parameter_path(p);
    EXPECT_FALSE(p.unit.empty()) << parameter_path(p);
    EXPECT_TRUE(paths.insert(parameter_path(p)).second) << parameter_path(p) << " twice";
  }
}

TEST_F(Parameters, AnEmptyFileIsTheDefaultBallastBox) {
  const Scene scene = read_scene(write("empty.prm", ""));
  EXPECT_EQ(scene.name, "empty");
  EXPECT_EQ(scene.container.length, 0.6);
  EXPECT_EQ(scene.gradation.curve, "shao2017_wide");
  EXPECT_EQ(scene.loading.largest, 8e4);
}

TEST_F(Parameters, WhatIsPrintedIsReadBack) {
  const auto table = scene_parameters();
  const Scene plain = read_scene(write("empty.prm", ""));
  const Scene prm = read_scene(write("a.prm", print_defaults(table, ParameterFormat::prm)));
  const Scene json = read_scene(write("a.json", print_defaults(table, ParameterFormat::json)));
  const Scene again = read_scene(write("b.prm", plain.resolved));
  EXPECT_EQ(prm.values, plain.values);
  EXPECT_EQ(json.values, plain.values);
  EXPECT_EQ(again.values, plain.values);
}

TEST(Freedom, Names) {
  EXPECT_EQ(freedom_of("six"), dem::kFree);
  EXPECT_EQ(freedom_of("vertical"), dem::kMoveZ);
  EXPECT_EQ(freedom_of("z,turn y"), dem::kMoveZ | dem::kTurnY);
  EXPECT_EQ(freedom_of(" x , y, z, turn x, turn y, turn z "), dem::kFree);
  for (const char* wrong : {"z, z", "turn", ",", "Z", "vertical, x"})
    EXPECT_EQ(freedom_of(wrong), -1) << wrong;
}

TEST_F(Parameters, PlainJsonWithNumbersAndLists) {
  const Scene scene = read_scene(write("a.json", R"({
    "Title": "A \"small\" one",
    "Gradation": {"Curve": "table", "Sieves": [0.0355, 0.045, 0.056], "Passing": [0, 40, 100]},
    "Sleeper": {"Model": "rigid", "Degrees of freedom": "vertical"},
    "Contact": {"Contact modulus": 1e8}})"));
  EXPECT_EQ(scene.title, "A \"small\" one");
  EXPECT_EQ(scene.gradation.sieves, (std::vector<double>{0.0355, 0.045, 0.056}));
  EXPECT_EQ(scene.contact.modulus, 1e8);
  EXPECT_EQ(scene.sleeper.freedom, dem::kMoveZ);
}

TEST_F(Parameters, IncludedFilesStandBelowTheIncludingOne) {
  std::filesystem::create_directory(file("common"));
  write("common/base.prm", "subsection Loading\n  set Cycles = 7\n  set Frequency = 3\nend\n");
  const Scene scene = read_scene(
      write("a.prm", "include common/base.prm\nsubsection Loading\n  set Cycles = 9\nend\n"));
  EXPECT_EQ(scene.loading.cycles, 9);
  EXPECT_EQ(scene.loading.frequency, 3);
}

TEST_F(Parameters, OverridesWinAndAreResolved) {
  const std::string file = write("a.prm", "subsection Grains\n  set Seed = 5\nend\n");
  const Scene scene = read_scene(file, {"Grains/Seed=9007199254740993", "Loading/Cycles = 3"});
  EXPECT_EQ(scene.grains.seed, 9007199254740993u);
  EXPECT_EQ(scene.loading.cycles, 3);
  EXPECT_NE(scene.resolved.find("9007199254740993"), std::string::npos);
}

TEST_F(Parameters, CommentsAndContinuedLines) {
  const auto entries = read_scene_text(write(
      "a.prm", "# first\nsubsection Sleeper # s\n  set Seats = -0.05, \\\n    0.05 # both\nend"));
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].path(), "Sleeper/Seats");
  EXPECT_EQ(entries[0].line, 3);
  std::vector<double> seats;
  EXPECT_TRUE(parse_numbers(entries[0].value, seats));
  EXPECT_EQ(seats, (std::vector<double>{-0.05, 0.05}));
}

TEST(Numbers, WholeTextOrNothing) {
  double x = 0;
  EXPECT_TRUE(parse_number("-1.5e-3", x));
  EXPECT_EQ(x, -1.5e-3);
  for (const char* wrong : {"", "1 2", "1.5m", "nan", "inf", "0x10", "1e999", "--1", "1,5"})
    EXPECT_FALSE(parse_number(wrong, x)) << wrong;
}

TEST_F(Parameters, EveryRegisteredSubgradeHasItsSectionAndItsWords) {
  const auto table = scene_parameters();
  const std::string printed = print_defaults(table, ParameterFormat::prm);
  for (const auto& [name, model] : fem::subgrade_models()) {
    EXPECT_NE(printed.find("subsection " + name), std::string::npos) << name;
    EXPECT_FALSE(section_documentation("Subgrade/" + name).empty()) << name;
    const Scene scene =
        read_scene(write(name + ".prm", "subsection Subgrade\n  set Model = " + name + "\nend\n"));
    EXPECT_EQ(scene.subgrade.values.size(), model.parameters.size()) << name;
    EXPECT_GT(make_subgrade_structure(scene, make_layout(scene))->mass(), 0) << name;
  }
}

TEST_F(Parameters, AValueOfASubgradeModelReachesIt) {
  const std::string file = write("a.prm", R"(
subsection Subgrade
  set Model = winkler
  subsection winkler
    set Mass = 100
  end
end)");
  const Scene light = read_scene(file);
  const Scene heavy = read_scene(file, {"Subgrade/winkler/Mass=200"});
  const Layout l = make_layout(light);
  EXPECT_NEAR(make_subgrade_structure(heavy, l)->mass(),
              2 * make_subgrade_structure(light, l)->mass(), 1e-9);
}

TEST_F(Parameters, AModelOfTheUsersOwnIsOneRegistration) {
  const auto names = subgrade_models();
  EXPECT_TRUE(std::count(names.begin(), names.end(), "my_bed"));
  const std::string file = write("a.prm", "subsection Subgrade\n  set Model = my_bed\nend\n");
  EXPECT_EQ(read_scene(file).subgrade.values.at("Settlement"), "1e-3");
  try {
    read_scene(file, {"Subgrade/my_bed/Settlement=2"});
    FAIL() << "2 m was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("from 1e-09 to 1 [m]"), std::string::npos)
        << error.what();
  }
}

TEST(Waveform, StartsAndEndsAtLeast) {
  for (const auto& name : waveforms()) {
    EXPECT_NEAR(waveform_load(name, 0, 0.1, 3, 80), 3, 1e-12) << name;
    EXPECT_NEAR(waveform_load(name, 0.05, 0.1, 3, 80), 80, 1e-12) << name;
    EXPECT_NEAR(waveform_load(name, 0.15, 0.1, 3, 80), 80, 1e-10) << name;
    EXPECT_NEAR(waveform_load(name, 0.2, 0.1, 3, 80), 3, 1e-10) << name;
  }
  EXPECT_NEAR(waveform_load("triangle", 0.0125, 0.1, 0, 80), 20, 1e-10);
  EXPECT_NEAR(waveform_load("sine", 0.025, 0.1, 0, 80), 40, 1e-10);
}

TEST(Scenes, AllThatAreShippedAreValid) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SCENES)) {
    if (entry.path().extension() != ".prm") continue;
    ++count;
    const Scene scene = read_scene(entry.path().string());
    EXPECT_GT(make_plan(scene, 2).grains, 10) << entry.path();
  }
  EXPECT_GE(count, 4);
}

TEST(Scenes, TheBallastBoxHasAbout730Grains) {
  // By hand: 108.36 kg, about 730 grains counted class by class with V = 0.6 d3.
  const Plan plan = make_plan(read_scene(SCENES "/ballast_box.prm"), 2);
  EXPECT_NEAR(plan.grains, 730, 40);
  EXPECT_LT(make_plan(read_scene(SCENES "/small_box.prm"), 2).grains, 100);
}

TEST(Scenes, HalfBySymmetryHalvesTheFullSleeper) {
  const std::string file = SCENES "/full_sleeper.prm";
  const Plan whole = make_plan(read_scene(file), 2);
  const Plan half = make_plan(read_scene(file, {"Container/Half by symmetry=true"}), 2);
  EXPECT_NEAR(half.grains, 0.5 * whole.grains, 1e-6 * whole.grains);
}

}  // namespace
}  // namespace trackbed::apps
