#include "apps/trackbed/simulation/run_stages.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>

#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/replay.h"
#include "apps/trackbed/simulation/stage_entry.h"
#include "apps/trackbed/simulation/stage_records.h"
#include "apps/trackbed/simulation/stage_step.h"
#include "apps/trackbed/simulation/watch.h"
#include "base/error.h"
#include "dem/packing/equilibrium.h"

namespace trackbed::apps {
namespace {

constexpr int kMonitorSteps = 100;  // between looks at limits and state
constexpr int kWatchSteps = 10;     // between looks at the porosity of a bed to be stopped

// How far from rest: kinetic energy, and where the stage asks for it the unbalanced force, over
// what is allowed; the larger.
double unrest(const Run& run, const Stage& stage) {
  const dem::Bodies& b = run.world.bodies;
  double kinetic = 0, weight = 0;
  for (int i = 0; i < b.grains; ++i) {
    kinetic += 0.5 * b.mass[i] * b.v[i].squaredNorm() + 0.5 * b.L[i].dot(b.omega[i]);
    weight += b.mass[i] * 9.81 * run.world.shapes.shape(b.shape[i]).sieve_size;
  }
  const double moves = kinetic / (run.scene.packing.quiet * weight);
  if (stage.unbalanced <= 0 || moves >= 1) return moves;
  const dem::Vec3 gravity = step_context(run, stage).gravity;
  return std::max(moves, dem::unbalanced_share(b, run.world.pairs, gravity) / stage.unbalanced);
}

bool at_rest(const Run& run, const Stage& stage) {
  return run.world.time - run.stage.start > 0.05 && stage.until_quiet && unrest(run, stage) < 1;
}

// What a stage was to reach and has not, said and kept for the summary.
void note_unmet(Run& run, const Stage& stage, bool reached, Progress& progress) {
  if (!stage.aim.empty() && !reached)
    progress.note(stage.name + ": ended by its longest time, " + stage.aim + " not reached");
  if (!stage.until_quiet) return;
  StageState& s = run.stage;
  s.unrest.resize(std::max<std::size_t>(s.unrest.size(), s.index + 1), 0.0);
  s.unrest[s.index] = unrest(run, stage);
  if (s.unrest[s.index] < 1) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%s: ended by its longest time, not at rest: %.2g times what Packing/Quiet%s allows",
      stage.name.c_str(), s.unrest[s.index], stage.unbalanced > 0 ? " or Unbalanced force" : "");
  progress.note(text);
}

void advance(Run& run, const Stage& stage) {
  StageState& s = run.stage;
  coupling::advance(run.world, step_context(run, stage), [&](coupling::World&, double time) {
    const double before = s.load;
    apply_load(run, stage.load(run, time - s.start));
    if (stage.ledger || stage.push) compress_pads(run, before, s.dt);
    if (stage.push) apply_push(run, stage.push(time - s.start));
  });
  s.steps += coupling::steps_per_exchange(run.world);
}

// A run on its way through its stages.
struct Way {
  using Clock = std::chrono::steady_clock;

  Run& run;
  const std::vector<Stage>& stages;
  int first_index;
  const std::string& folder;
  Recorder& recorder;
  SnapshotLog& snapshots;
  Progress& progress;
  Watch& watch;
  Clock::time_point saved = Clock::now();
  bool kept = std::filesystem::exists(folder + "/checkpoint.h5");

  const Stage& stage_now() const {
    const std::size_t k = run.stage.index - first_index;
    return stages[std::min(k, stages.size() - 1)];
  }

  void checkpoint() {
    recorder.flush();
    save_run(folder + "/checkpoint.h5", run, {recorder.rows(), snapshots});
    saved = Clock::now();
    kept = true;
  }

  bool checkpoint_due() const {
    const double minutes = run.scene.output.checkpoint_interval;
    const std::chrono::duration<double> since = Clock::now() - saved;
    return minutes > 0 && since.count() > 60 * minutes;
  }

  // At the stage's start, or where it goes on after a checkpoint.
  void begin(const Stage& stage) {
    const bool resumed = run.stage.dt > 0 && run.stage.steps > 0;
    if (resumed) {
      choose_laws(run, stage);
      set_step(run, run.stage.dt);
      watch = start_watch(run);
    } else {
      watch = {};  // the stage before knows nothing of the bodies that come
      enter_stage(run, stage);
      watch = start_watch(run);
      inspect(run, stage, watch);
      record_start(run, stage, recorder);
    }
    progress.begin(stage.name, run.world.time, run.stage.start + stage.longest);
  }

  // Looks at limits and overlaps.
  void look_around(const Stage& stage) {
    const coupling::World& w = run.world;
    inspect(run, stage, watch);
    run.stage.largest_overlap = std::max(run.stage.largest_overlap,
                                         dem::deepest_overlap(w.bodies, w.shapes, w.pairs).share);
    watch_step(run, stage, progress);
  }

  // What the last `taken` steps are written down with. True: the load cycles are over.
  bool record(const Stage& stage, int taken) {
    StageState& s = run.stage;
    const int interval = run.scene.output.energy_interval;
    if (sample_due(s, taken, run.scene)) {
      keep_grain_forces(run);
      recorder.sample(run, stage);
    } else if (interval > 0 && reached(s, interval, taken)) {
      recorder.energy(run, stage);
    }
    if (s.steps_per_cycle == 0) return false;
    const bool over = record_cycle(run, stage, recorder, folder);
    if (s.steps % s.steps_per_cycle == 0) check_ledger(run, stage);
    return over;
  }

  // To the end of the stage, or until a stop is requested.
  Ending take(const Stage& stage) {
    begin(stage);
    StageState& s = run.stage;
    const OutputScene& out = run.scene.output;
    const int taken = coupling::steps_per_exchange(run.world);
    bool over = false, met = false;
    while (!over) {
      advance(run, stage);
      if (stage.control) over = stage.control(run, stage);
      const bool look = reached(s, kMonitorSteps, taken);
      if (look) look_around(stage);
      if (stage.watch && reached(s, kWatchSteps, taken) && stage.watch(run))
        run.world.materials = make_materials(run.scene, stage.modulus, s.friction);
      const bool reached_aim = record(stage, taken);
      met = met || reached_aim;
      over = reached_aim || over;
      over = over || (look && at_rest(run, stage)) ||
             run.world.time - s.start > stage.longest - 0.5 * taken * s.dt;
      const bool stop = stop_requested() && !over, due = checkpoint_due();
      // Nothing is kept that a look would refuse.
      if ((over || stop || due) && !look) inspect(run, stage, watch);
      if (over || snapshot_due(s, taken, out.snapshot_interval))
        write_snapshot(run, stage, folder, out.structure_fields, snapshots);
      if (progress.due()) progress.update(run.world.time, progress_detail(run));
      if (stop || due || (look && !kept)) checkpoint();
      if (stop) {
        progress.finish(run.world.time, "stopped, checkpoint written");
        return Ending::stopped;
      }
    }
    if (stage.control) {
      recorder.sample(run, stage);
      check_ledger(run, stage);
    }
    progress.finish(run.world.time, progress_detail(run));
    note_unmet(run, stage, met, progress);
    return Ending::done;
  }

  Ending take_all() {
    StageState& s = run.stage;
    for (int k = s.index - first_index; k < static_cast<int>(stages.size());) {
      s.index = first_index + k;
      if (take(stages[k]) == Ending::stopped) return Ending::stopped;
      if (!stages[k].again || !stages[k].again(run)) ++k;
      s.index = first_index + k;
      s.dt = 0, s.steps = 0;
      checkpoint();
    }
    return Ending::done;
  }

  // The same message with the pair's own scene, which is written.
  [[noreturn]] void give_up(const dem::StateFault& fault) const {
    const dem::Bodies& before = watch.before;
    const auto* of_surface = dynamic_cast<const SurfaceFault*>(&fault);
    std::string scene, who;
    if (of_surface) {
      const coupling::Surface& s = run.world.surfaces[of_surface->surface];
      who =
          "Grain " + std::to_string(fault.a) + " and a held block in place of the " + s.patch.name;
      scene = write_offender(
          run, stage_now(), offender_of(run, before, fault.a),
          surface_at(run, s, of_surface->contact, run.world.time - watch.before_time), who, folder);
    } else if (fault.b >= 0 && fault.a != fault.b && std::max(fault.a, fault.b) < before.size()) {
      who = "Bodies " + std::to_string(fault.a) + " and " + std::to_string(fault.b);
      scene = write_offender(run, stage_now(), offender_of(run, before, fault.a),
                             offender_of(run, before, fault.b), who, folder);
    }
    if (scene.empty()) throw RunError(fault.what());
    throw RunError(std::string(fault.what()) + " " + who +
                   " alone, from the last look before: trackbed run " + scene + ".");
  }
};

}  // namespace

Ending run_stages(Run& run, const std::vector<Stage>& stages, int first_index,
                  const std::string& folder, Recorder& recorder, SnapshotLog& snapshots,
                  Progress& progress) {
  Watch watch;
  Way way{run, stages, first_index, folder, recorder, snapshots, progress, watch};
  try {
    try {
      return way.take_all();
    } catch (const dem::StateFault&) {
      throw;
    } catch (const RunError&) {
      // May know which grain it was.
      if (watch.before.size() > 0) inspect(run, way.stage_now(), watch);
      throw;
    }
  } catch (const dem::StateFault& fault) {
    way.give_up(fault);
  }
}

}  // namespace trackbed::apps
