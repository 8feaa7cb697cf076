// Angle of repose by a lifted wall: the box's side at high x goes up at a constant speed, the
// grains flow out over a floor that ends at a wall, and when they lie still the slope of their
// surface is the angle. The lifted wall is frictionless, so that it does not carry grains up; the
// sides along x are walls, or a seam where the scene is periodic (a long heap: no wall carries part
// of it).
#include <algorithm>
#include <cmath>

#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/grain_tests/walls.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/materials.h"
#include "coupling/edit.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

double highest(const Run& run) {
  return highest_grain(run, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL);
}

// The lifted wall is the last one.
void open_box(Run& run) {
  begin_specimen(run);
  run.test.high.z() = highest(run);
  const double t = wall_thickness, end = run.test.high.x() + run.scene.test.floor_length;
  const Vec3 low = run.test.low, high = run.test.high;
  const double y0 = low.y() - t, y1 = high.y() + t;
  add_test_wall(run, {low.x() - t, y0, low.z() - t}, {end + t, y1, low.z()}, kSubgrade);
  add_test_wall(run, {low.x() - t, y0, low.z() - t}, {low.x(), y1, wall_top}, kWall);
  add_test_wall(run, {end, y0, low.z() - t}, {end + t, y1, wall_top}, kWall);
  if (!run.scene.container.periodic) {
    add_test_wall(run, {low.x() - t, y0, low.z() - t}, {end + t, low.y(), wall_top}, kWall);
    add_test_wall(run, {low.x() - t, high.y(), low.z() - t}, {end + t, y1, wall_top}, kWall);
  }
  add_test_wall(run, {high.x(), y0, low.z()}, {high.x() + t, y1, wall_top}, kMirror);
  run.world.bodies.v[wall(run, run.actors.walls - 1)].z() = run.scene.test.speed;
}

void take_wall_away(Run& run) {
  coupling::remove_bodies(run.world, {wall(run, run.actors.walls - 1)});
  --run.actors.walls;
}

}  // namespace

std::vector<Stage> repose_stages(const Scene& s) {
  // The wall is off once its lower edge is above every grain.
  Stage lifting = bed_stage(s, "lifting", s.container.depth * 2 / s.test.speed, s.contact.damping);
  lifting.enter = open_box;
  lifting.control = [](Run& run, const Stage&) {
    const double gone = wall_travel(run, run.actors.walls - 1).z();
    return gone > run.test.high.z() && gone > highest(run);
  };
  Stage flow = bed_stage(s, "flow", s.test.rest_time, s.contact.packing_damping);
  flow.enter = take_wall_away;
  flow.until_quiet = true;
  return {lifting, flow};
}

}  // namespace trackbed::apps
