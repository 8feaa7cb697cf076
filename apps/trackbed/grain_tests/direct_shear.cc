// Direct shear box. The bed is cut by a horizontal plane: below it a held box, above it one that
// moves along x, and a lid that goes with the upper box and keeps the normal force on the plane. By
// the balance of the grains above the plane, inertia left out,
//   normal force = vertical force on lid and upper box + weight of these grains
//   shear force  = force that the upper box needs along x
// Friction on the upper box's walls is thus in the normal force, not an error of it. Stresses refer
// to the first area of the plane: a constant force, as with a dead load.
#include <algorithm>
#include <cmath>

#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/grain_tests/walls.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/materials.h"
#include "dem/packing/packed_grains.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

// In the order in which they are put in.
enum Wall { kFloor, kLowerSides, kUpperSides = 5, kTopLid = 9, kAllWalls = 10 };
constexpr double kClearance = 1e-4;  // of the lid over the highest grain [m]
constexpr double kBand = 10;         // grains, thickness of a shear band

// Four sides around the inner space, between two heights.
void add_sides(Run& run, double from, double to) {
  const double t = wall_thickness;
  const Vec3 low = run.test.low, high = run.test.high;
  const double x0 = low.x(), x1 = high.x(), y0 = low.y(), y1 = high.y();
  add_test_wall(run, {x0 - t, y0 - t, from}, {x0, y1 + t, to}, kWall);
  add_test_wall(run, {x1, y0 - t, from}, {x1 + t, y1 + t, to}, kWall);
  add_test_wall(run, {x0 - t, y0 - t, from}, {x1 + t, y0, to}, kWall);
  add_test_wall(run, {x0 - t, y1, from}, {x1 + t, y1 + t, to}, kWall);
}

void fill_box(Run& run) {
  begin_specimen(run);
  GrainTestState& t = run.test;
  t.high.z() = highest_grain(run, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL) + kClearance;
  t.plane = run.scene.test.shear_plane *
            dem::measure_bed(run.world.bodies, run.world.shapes, run.layout.area, t.low.z()).height;
  const Vec3 beyond = Vec3::Constant(wall_thickness);
  const Vec3 low = t.low - beyond, high = t.high + beyond;
  add_test_wall(run, low, {high.x(), high.y(), t.low.z()}, kSubgrade);
  add_sides(run, low.z(), t.plane);
  add_sides(run, t.plane, wall_top);
  add_test_wall(run, {low.x(), low.y(), t.high.z()}, high, kPlate);
}

struct PlaneForce {
  double normal = 0, shear = 0;  // [N]
};

PlaneForce plane_force(const Run& run) {
  const dem::Bodies& b = run.world.bodies;
  PlaneForce f;
  for (int k = kUpperSides; k < kAllWalls; ++k) {
    f.normal += b.force[wall(run, k)].z();
    f.shear -= b.force[wall(run, k)].x();
  }
  const double g = -dem::StepContext{}.gravity.z();
  for (int i = 0; i < b.grains; ++i)
    if (b.x[i].z() > run.test.plane) f.normal += b.mass[i] * g;
  return f;
}

double normal_target(const Run& run) { return test_stress(run) * run.layout.area; }

void load_lid(Run& run, double normal) {
  drive_wall(run, kTopLid, kTopLid, {0, 0, -1}, normal_target(run), normal);
}

Stage consolidation(const Scene& s, double stress) {
  Stage stage = bed_stage(s, stress_name("consolidation", stress), s.test.consolidation_time,
                          s.contact.packing_damping);
  stage.ledger = false;  // what rings down here is more than the work that is put in
  stage.enter = fill_box;
  stage.control = [](Run& run, const Stage& now) {
    const double normal = plane_force(run).normal;
    load_lid(run, normal);
    return consolidated(run, now, {normal / normal_target(run) - 1});
  };
  return stage;
}

Stage shear(const Scene& s, double stress) {
  // A row's end may lie a step late.
  Stage stage = bed_stage(s, stress_name("shear", stress), 1.01 * s.test.travel / s.test.speed,
                          s.contact.damping);
  stage.enter = [](Run& run) {
    run.test.steps = 0;
    run.test.lengths = run.test.high - run.test.low + wall_travel(run, kTopLid);
    for (int k = kUpperSides; k < kAllWalls; ++k)
      run.world.bodies.v[wall(run, k)].x() = run.scene.test.speed;
  };
  stage.control = [](Run& run, const Stage&) {
    const PlaneForce f = plane_force(run);
    load_lid(run, f.normal);
    const Vec3 u = wall_travel(run, kTopLid);
    const double dilation = u.z() + run.test.high.z() - run.test.low.z() - run.test.lengths.z();
    const double volume = run.layout.area * (run.test.lengths.z() + dilation);
    const bool last = add_to_row(
        run, {run.world.time, u.x(), f.shear, f.normal, dilation, 1 - run.test.solid / volume},
        u.x() / run.scene.test.travel);
    if (last) ++run.test.specimen;
    return last;
  };
  return stage;
}

}  // namespace

std::vector<Stage> shear_stages(const Scene& s) {
  std::vector<Stage> stages;
  for (const double stress : s.test.stresses) {
    stages.push_back(consolidation(s, stress));
    stages.push_back(shear(s, stress));
  }
  return stages;
}

double inertial_number(const Scene& s, double d) {
  if (s.test.type == "angle_of_repose") return 0;
  const double stress = *std::min_element(s.test.stresses.begin(), s.test.stresses.end());
  const double rate = s.test.type == "triaxial" ? s.test.strain_rate : s.test.speed / (kBand * d);
  return rate * inertial_time(s, d, stress);
}

}  // namespace trackbed::apps
