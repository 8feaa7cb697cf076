#include "apps/trackbed/grain_tests/walls.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>

#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/saved_run.h"
#include "base/error.h"
#include "coupling/edit.h"
#include "dem/packing/equilibrium.h"
#include "dem/surface/rigid.h"
#include "dem/surface/servo.h"

namespace trackbed::apps {
namespace {

constexpr int kLook = 200;              // steps between looks whether a specimen is consolidated
constexpr double kServoInertia = 0.01;  // largest inertial number that a servo's wall may cause

std::string kept_bed(const Run& run) { return run.folder + "/test_bed.h5"; }

// By mass, of the sieve sizes; of grains without one (from OFF files) the cube's of their volume.
double mean_size(const Run& run) {
  const dem::Bodies& b = run.world.bodies;
  double sum = 0, mass = 0;
  for (int i = 0; i < b.grains; ++i) {
    const dem::GrainShape& g = run.world.shapes.shape(b.shape[i]);
    sum += b.mass[i] * (g.sieve_size > 0 ? g.sieve_size : std::cbrt(g.volume));
    mass += b.mass[i];
  }
  return sum / mass;
}

}  // namespace

void begin_specimen(Run& run) {
  GrainTestState& t = run.test;
  if (run.scene.test.type != "angle_of_repose" && run.scene.test.stresses.size() > 1) {
    if (t.specimen == 0)
      save_run(kept_bed(run), run, {});
    else
      restore_bed(kept_bed(run), run);
  }
  std::vector<int> rigid(run.world.bodies.size() - run.world.bodies.grains);
  std::iota(rigid.begin(), rigid.end(), run.world.bodies.grains);
  coupling::remove_bodies(run.world, rigid);
  run.actors.walls = 0;
  run.actors.floor = run.actors.plate = run.actors.rigid_sleeper = false;
  t.placed.clear(), t.drift.clear(), t.sum.clear();
  t.steps = t.rows_done = 0;
  t.size = mean_size(run);
  t.solid = 0;
  for (int i = 0; i < run.world.bodies.grains; ++i)
    t.solid += run.world.shapes.shape(run.world.bodies.shape[i]).volume;
  t.low = run.layout.low, t.high = run.layout.high;
}

void forget_test_bed(const Run& run) { std::filesystem::remove(kept_bed(run)); }

void add_test_wall(Run& run, const dem::Vec3& low, const dem::Vec3& high, int material) {
  const int i =
      dem::add_box(run.world.bodies, run.world.shapes, low, high, material, 1, dem::kFixed);
  run.test.placed.push_back(run.world.bodies.x[i]);
  run.test.drift.push_back(0);
  ++run.actors.walls;
}

void hold_walls(Run& run) {
  for (int k = 0; k < run.actors.walls; ++k) run.world.bodies.v[wall(run, k)].setZero();
}

void drive_wall(Run& run, int servo, int k, const dem::Vec3& inward, double target, double force) {
  const GrainTestState& t = run.test;
  const double height = t.high.z() - t.low.z();
  const double fastest =
      kServoInertia * height / inertial_time(run.scene, t.size, test_stress(run));
  const double stiffness = dem::wall_stiffness(run.world.pairs, wall(run, k), inward);
  const double speed =
      dem::servo_speed(target, force, stiffness, run.stage.dt, fastest, run.test.drift[servo]);
  dem::Vec3& v = run.world.bodies.v[wall(run, k)];
  v += (speed - v.dot(inward)) * inward;
}

double test_stress(const Run& run) { return run.scene.test.stresses[run.test.specimen]; }

bool add_to_row(Run& run, const std::vector<double>& values, double position) {
  GrainTestState& t = run.test;
  if (t.steps == 0) t.sum.assign(values.size(), 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) t.sum[k] += values[k];
  ++t.steps;
  const int samples = run.scene.test.samples;
  // Rounding of many small moves must not cost a step.
  if (position * samples < t.rows_done + 1 - 1e-9) return false;
  t.rows.push_back(t.specimen);
  for (const double sum : t.sum) t.rows.push_back(sum / t.steps);
  t.steps = 0;
  return ++t.rows_done >= samples;
}

bool consolidated(Run& run, const Stage& stage, const std::vector<double>& errors) {
  GrainTestState& t = run.test;
  const GrainTestScene& test = run.scene.test;
  if (t.steps == 0) t.sum.assign(errors.size(), 0.0);
  for (std::size_t k = 0; k < errors.size(); ++k) t.sum[k] += errors[k];
  ++t.steps;
  const bool late = run.world.time - run.stage.start > test.consolidation_time - 2 * run.stage.dt;
  if (t.steps < kLook && !late) return false;
  double worst = 0;
  for (const double sum : t.sum) worst = std::max(worst, std::abs(sum) / t.steps);
  t.steps = 0;
  const double unbalanced =
      dem::unbalanced_share(run.world.bodies, run.world.pairs, step_context(run, stage).gravity);
  if (worst <= test.tolerance && unbalanced < run.scene.packing.unbalanced) return true;
  if (!late) return false;
  char text[400];
  std::snprintf(
      text, sizeof text,
      ": Test/Consolidation time = %g: at %.4g Pa the specimen has not come to rest: the "
      "stress is off by %.2g of it (Test/Tolerance = %g), the unbalanced force is %.2g of "
      "the contact force (Packing/Unbalanced force = %g); a longer time is needed",
      test.consolidation_time, test_stress(run), worst, test.tolerance, unbalanced,
      run.scene.packing.unbalanced);
  throw InputError(run.scene.file + text);
}

double inertial_time(const Scene& scene, double grain_size, double stress) {
  return grain_size * std::sqrt(scene.grains.density / stress);
}

std::string stress_name(const std::string& what, double stress) {
  char text[64];
  std::snprintf(text, sizeof text, "%s %.4g kPa", what.c_str(), 1e-3 * stress);
  return text;
}

}  // namespace trackbed::apps
