#include "apps/trackbed/simulation/stage_records.h"

#include <algorithm>
#include <cstdio>

#include "apps/trackbed/simulation/bearing.h"
#include "apps/trackbed/simulation/subgrade_bearing.h"
#include "dem/packing/packed_grains.h"

namespace trackbed::apps {
namespace {

constexpr double kSampleTime = 5e-3;  // between lines of history in a stage without cycles [s]

// The step of a cycle that comes nearest to the peak of its load: one at the end of an exchange.
int peak_step(const Stage& stage, int steps_per_cycle, int per_exchange) {
  return per_exchange * static_cast<int>(stage.peak * steps_per_cycle / per_exchange + 0.5);
}

}  // namespace

bool reached(const StageState& s, int interval, int taken) {
  return s.steps / std::max(1, interval) != (s.steps - taken) / std::max(1, interval);
}

bool sample_due(const StageState& s, int taken, const Scene& scene) {
  if (s.steps_per_cycle > 0) {
    const int samples = 2 * std::max(1, scene.output.samples_per_cycle / 2);
    return s.steps % (s.steps_per_cycle / samples) == 0;
  }
  return reached(s, static_cast<int>(kSampleTime / s.dt), taken);
}

bool snapshot_due(const StageState& s, int taken, double interval) {
  return interval > 0 && reached(s, static_cast<int>(interval / s.dt + 0.5), taken);
}

bool record_cycle(Run& run, const Stage& stage, Recorder& recorder, const std::string& folder) {
  StageState& s = run.stage;
  const int phase = s.steps % s.steps_per_cycle;
  const bool tamping = run.actors.plate;
  if (!tamping &&
      phase == peak_step(stage, s.steps_per_cycle, coupling::steps_per_exchange(run.world))) {
    s.u_max = sleeper_displacement(run) - s.u0;
    s.load_max = s.load;
    keep_pressure(run);
    write_moment(run, folder + "/moment.csv");  // these of the last peak
    write_rail_seats(run, folder + "/rail_seats.csv");
    write_subgrade_pressure(run, folder);
  }
  if (phase != 0) return false;
  ++s.cycles;
  if (tamping) {
    recorder.compaction(run);
  } else {
    const double u_start = s.u_min, load_start = s.load_min;
    s.u_min = sleeper_displacement(run) - s.u0;
    s.load_min = s.load;
    recorder.cycle(run, stage, load_start, u_start);
  }
  return stage.after_cycle && stage.after_cycle(run);
}

std::string progress_detail(const Run& run) {
  char text[80] = "";
  if (run.actors.plate)
    std::snprintf(text, sizeof text, "cycle %d, density %.0f kg/m3", run.stage.cycles,
                  bed_density(run));
  else if (!run.path.empty() && !run.actors.rigid_sleeper)
    std::snprintf(
        text, sizeof text, "friction %.3g, porosity %.4f", run.stage.friction,
        dem::measure_bed(run.world.bodies, run.world.shapes, run.layout.area, 0).porosity);
  else if (run.stage.steps_per_cycle > 0)
    std::snprintf(text, sizeof text, "cycle %d, settlement %.3f mm", run.stage.cycles,
                  1e3 * run.stage.u_min);
  else
    std::snprintf(text, sizeof text, "%d contacts", coupling::count_contacts(run.world));
  return text;
}

void record_start(Run& run, const Stage& stage, Recorder& recorder) {
  StageState& s = run.stage;
  if (stage.period > 0 && run.actors.plate) recorder.compaction(run);
  if (stage.period > 0 && !run.actors.plate) {
    s.u0 = sleeper_displacement(run);
    s.u_min = 0, s.load_min = s.load;
  }
  recorder.sample(run, stage);
}

void keep_grain_forces(Run& run) {
  const coupling::World& w = run.world;
  std::vector<double>& most = run.stage.grain_force;
  const auto keep = [&](int body, double force) {
    if (body < w.bodies.grains) most[body] = std::max(most[body], force);
  };
  for (int p = 0; p < w.pairs.size(); ++p) {
    if (!w.pairs.touching[p]) continue;
    const double force = w.pairs.force[p].norm();
    keep(w.pairs.a[p], force), keep(w.pairs.b[p], force);
  }
  for (const coupling::Surface& s : w.surfaces)
    for (int i = 0; i < s.contacts.size(); ++i)
      if (s.contacts.touching[i]) keep(s.contacts.grain[i], s.contacts.force[i].norm());
}

}  // namespace trackbed::apps
