// A stage's start and records, on runs made by hand: what is kept of the stage before, the noise of
// the start, moment and seat loads of a whole and a half sleeper by statics.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "apps/trackbed/files.h"
#include "apps/trackbed/read_scene.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/bearing.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/stage_entry.h"
#include "apps/trackbed/simulation/subgrade_bearing.h"
#include "apps/trackbed/simulation/watch.h"
#include "apps/trackbed/simulation/zones.h"
#include "base/error.h"
#include "coupling/edit.h"
#include "dem/motion/monitor.h"
#include "tests/scratch_folder.h"

namespace trackbed::apps {
namespace {

using Changes = std::vector<std::string>;

Run run_of(const Changes& changes = {}) {
  Run run;
  run.scene = read_scene(TINY, changes);
  run.layout = make_layout(run.scene);
  return run;
}

// Two cubes that do not touch.
void add_cubes(Run& run) {
  const dem::GrainShape cube = dem::make_grain_shape(dem::make_box({.05, .05, .05}));
  coupling::add_grains(run.world, {cube, cube}, {{.01, .02, .1}, {.11, .02, .1}},
                       {dem::Quat::Identity(), dem::Quat::Identity()}, 2600, kGrain);
}

TEST(StageStart, without_noise_no_bit_moves) {
  for (const double noise : {0., 1e-12}) {
    apps::Run run = run_of();
    run.scene.numerics.mirror_noise = noise;
    add_cubes(run);
    const dem::Vec3 x = run.world.bodies.x[0];
    enter_stage(run, bed_stage(run.scene, "test", 1, 0));
    EXPECT_EQ(run.world.bodies.x[0] == x, noise == 0);
    EXPECT_NEAR((run.world.bodies.x[0] - x).norm(), noise * x.norm(), 1e-17);
  }
}

TEST(StageStart, what_grains_bore_is_of_this_bed) {
  apps::Run run = run_of();
  add_cubes(run);
  run.stage.grain_force = {7, 8, 9};  // one of them was trimmed away
  run.stage.largest_overlap = run.stage.largest_step_share = .5;
  Stage stage = bed_stage(run.scene, "test", 1, 0);
  enter_stage(run, stage);
  EXPECT_EQ(run.stage.grain_force, std::vector<double>(2, 0.));
  EXPECT_EQ(run.stage.largest_overlap, 0);
  EXPECT_EQ(run.stage.largest_step_share, 0);
  run.stage.grain_force = {1, 2}, run.stage.largest_overlap = .5;
  stage.goes_on = true;
  enter_stage(run, stage);
  EXPECT_EQ(run.stage.grain_force, (std::vector<double>{1, 2}));
  EXPECT_EQ(run.stage.largest_overlap, .5);
}

TEST(StageStart, loading_goes_on_with_the_bed_of_seating) {
  const auto stages = loading_stages(read_scene(TINY, {"Loading/Push=longitudinal"}));
  ASSERT_EQ(stages.size(), 3u);
  EXPECT_FALSE(stages[0].goes_on);
  EXPECT_TRUE(stages[1].goes_on && stages[2].goes_on);
}

// Rows of numbers below a file's head line.
std::vector<std::vector<double>> rows_of(const std::string& file) {
  std::istringstream in(read_text(file));
  std::vector<std::vector<double>> rows;
  std::string line, cell;
  for (std::getline(in, line); std::getline(in, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST(Bearing, moment_and_seats_of_a_sleeper_in_the_air) {
  const ScratchFolder folder;
  const double load = 8e4;
  for (const char* seats : {"0", "-0.015, 0.015"})
    for (const char* half : {"false", "true"}) {
      const Changes changes{std::string("Container/Half by symmetry=") + half,
                            std::string("Sleeper/Seats=") + seats, "Sleeper/Seat length=0.02"};
      apps::Run run = run_of(changes);
      const SleeperScene& s = run.scene.sleeper;
      add_rigid_sleeper(run);
      run.stage.load = load;
      write_moment(run, folder.file("moment.csv"));
      write_rail_seats(run, folder.file("rail_seats.csv"));
      // Of what lies right of x = 0: half of the load and of the weight.
      const double arm = s.seats.size() == 1 ? .02 / 4 : .015;
      const double weight = 9.81 * s.density * s.width * s.height * s.length / 2;
      const auto moment = rows_of(folder.file("moment.csv"));
      const auto& middle = run.scene.container.half ? moment.front() : moment[moment.size() / 2];
      EXPECT_NEAR(middle[0], 0, 1e-15);
      EXPECT_NEAR(middle[2], -load / 2 * arm - weight * s.length / 4, 1e-9 * load) << seats << half;
      for (const auto& seat : rows_of(folder.file("rail_seats.csv")))
        EXPECT_NEAR(seat[2], load / static_cast<double>(s.seats.size()), 1e-9 * load) << half;
    }
}

TEST(Zones, of_no_margin_leave_coarse_grains_beside_the_sleeper) {
  apps::Run run =
      run_of({"Zones/Use=true", "Zones/Margin=0", "Zones/Transition=0", "Zones/Size ratio=1.2",
              "Container/Length=0.3", "Container/Ballast depth=0.08"});
  const GrainBatch under = draw_batch(run, 1, 0, false), beside = draw_batch(run, 1, 1, true);
  EXPECT_GT(under.fine, 0);
  EXPECT_GT(static_cast<int>(under.grains.size()), under.fine);
  EXPECT_EQ(beside.fine, 0);
  EXPECT_GT(beside.grains.size(), 0u);
}

TEST(Watch, a_sleeper_beside_the_bed_stops_the_run) {
  apps::Run run = run_of();
  add_cubes(run);
  add_rigid_sleeper(run);
  const Stage stage = bed_stage(run.scene, "test", 1, 0);
  Watch watch = start_watch(run);
  EXPECT_NO_THROW(inspect(run, stage, watch));
  run.world.bodies.x[run.world.bodies.grains].z() -= run.actors.sleeper_base + .01;
  EXPECT_THROW(inspect(run, stage, watch), RunError);
}

TEST(Books, energy_made_by_a_structure_stops_the_run) {
  apps::Run run = run_of();
  add_cubes(run);
  const Stage stage = bed_stage(run.scene, "test", 1, 0);
  run.stage.work_in = 100;
  run.stage.structure_gain = 0.9 * 100 * run.scene.numerics.closure;
  EXPECT_NO_THROW(check_ledger(run, stage));
  run.stage.structure_gain *= 1.3;
  try {
    check_ledger(run, stage);
    FAIL() << "was not stopped";
  } catch (const dem::StateFault& fault) {
    EXPECT_NE(std::string(fault.what()).find("structures' time integration made"),
              std::string::npos)
        << fault.what();
  }
}

}  // namespace
}  // namespace trackbed::apps
