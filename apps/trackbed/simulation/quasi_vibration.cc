#include "apps/trackbed/simulation/quasi_vibration.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/saved_run.h"
#include "base/error.h"
#include "dem/packing/equilibrium.h"
#include "dem/packing/packed_grains.h"

namespace trackbed::apps {
namespace {

std::string kept_bed(const Run& run, int point) {
  char name[32];
  std::snprintf(name, sizeof name, "/path_%02d.h5", point);
  return run.folder + name;
}

// Anew each time: relative densities are known last.
void write_path(const Run& run) {
  const std::size_t rungs = run.scene.packing.friction_path.size();
  CsvWriter csv(run.folder + "/friction_path.csv",
                {"trial", "from_trial", "friction", "stopped_at_porosity", "porosity", "void_ratio",
                 "relative_density", "height_m", "coordination", "unbalanced_share", "time_s"});
  for (std::size_t k = 0; k < run.path.size(); ++k) {
    const PathPoint& p = run.path[k];
    const double n = p.point.porosity;
    CsvCell density;  // known once both ends are
    if (run.path.size() >= rungs && run.path[0].point.porosity > run.path[rungs - 1].point.porosity)
      density = dem::relative_density_at(n, run.path[0].point.porosity,
                                         run.path[rungs - 1].point.porosity);
    csv.row({k, p.point.from >= 0 ? CsvCell(p.point.from) : CsvCell(), p.point.friction,
             p.point.stop_at > 0 ? CsvCell(p.point.stop_at) : CsvCell(), n, n / (1 - n), density,
             p.height, p.coordination, p.unbalanced, p.time});
  }
  csv.flush();
}

void check_rest(const Run& run, double unbalanced) {
  const PackingScene& p = run.scene.packing;
  if (unbalanced < p.unbalanced) return;
  char text[240];
  std::snprintf(text, sizeof text,
                ": Packing/Settle time = %g: with friction %.3g the bed has not come to rest, the "
                "unbalanced force is %.2g of the contact force and Packing/Unbalanced force = %g; "
                "a longer time is needed",
                p.settle_time, run.stage.friction, unbalanced, p.unbalanced);
  throw InputError(run.scene.file + text);
}

void note_point(Run& run, int from, double stop_at) {
  const coupling::World& w = run.world;
  const dem::BedMeasure bed = dem::measure_bed(w.bodies, w.shapes, run.layout.area, 0);
  PathPoint p;
  p.point = {from, run.stage.friction, bed.porosity, stop_at};
  p.height = bed.height;
  p.coordination = coupling::coordination(w);
  p.unbalanced = dem::unbalanced_share(w.bodies, w.pairs, dem::StepContext{}.gravity);
  p.time = w.time;
  check_rest(run, p.unbalanced);
  run.path.push_back(p);
  save_run(kept_bed(run, static_cast<int>(run.path.size()) - 1), run, {});
  write_path(run);
}

dem::FrictionStep step_of(const Run& run) {
  std::vector<dem::FrictionPoint> points;
  for (const PathPoint& p : run.path) points.push_back(p.point);
  const PackingScene& p = run.scene.packing;
  try {
    return dem::next_step(path_settings(run.scene), points);
  } catch (const InputError& e) {
    const std::string key =
        p.target_porosity >= 0 ? "Packing/Target porosity" : "Packing/Target relative density";
    throw InputError(run.scene.file + ": " + key + " = " + run.scene.values.at(key) + ": " +
                     e.what());
  }
}

}  // namespace

dem::FrictionPathSettings path_settings(const Scene& s) {
  dem::FrictionPathSettings path;
  path.friction = s.packing.friction_path;
  path.porosity = s.packing.target_porosity;
  if (path.porosity < 0) path.relative_density = s.packing.target_relative_density;
  path.tolerance = s.packing.porosity_tolerance;
  return path;
}

void begin_trial(Run& run) {
  if (run.path.empty()) {
    run.stage.friction = run.scene.packing.friction_path.front();
    note_point(run, -1, 0);
  }
  const dem::FrictionStep step = step_of(run);
  // Done with the deposit: it rests on for a moment with the friction it has.
  const double before = run.path[step.point].point.friction;
  run.stage.friction = step.done ? before : step.friction;
  run.stage.stop_at = step.stop_at, run.stage.stop_friction = before;
  if (step.point != static_cast<int>(run.path.size()) - 1)
    restore_bed(kept_bed(run, step.point), run);
}

bool stop_bed(Run& run) {
  StageState& s = run.stage;
  if (s.stop_at <= 0) return false;
  const coupling::World& w = run.world;
  if (dem::measure_bed(w.bodies, w.shapes, run.layout.area, 0).porosity > s.stop_at) return false;
  s.friction = s.stop_friction;
  s.stop_at = 0;
  return true;
}

bool trial_follows(Run& run) {
  const dem::FrictionStep before = step_of(run);
  if (!before.done) note_point(run, before.point, before.stop_at);
  const dem::FrictionStep step = step_of(run);
  if (!step.done) return true;
  if (step.point != static_cast<int>(run.path.size()) - 1)
    restore_bed(kept_bed(run, step.point), run);
  run.stage.friction = run.path[step.point].point.friction;
  return false;
}

double bed_friction(const Run& run) {
  const dem::FrictionStep step = step_of(run);
  return run.path.at(step.point).point.friction;
}

void forget_trials(const Run& run) {
  for (std::size_t k = 0; k < run.path.size(); ++k)
    std::filesystem::remove(kept_bed(run, static_cast<int>(k)));
}

}  // namespace trackbed::apps
