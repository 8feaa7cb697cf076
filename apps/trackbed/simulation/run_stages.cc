#include "apps/trackbed/simulation/run_stages.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/trackbed/signals.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/bearing.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/replay.h"
#include "apps/trackbed/simulation/subgrade_bearing.h"
#include "apps/trackbed/simulation/watch.h"
#include "base/error.h"
#include "coupling/time_step.h"
#include "dem/packing/equilibrium.h"
#include "dem/packing/packed_grains.h"

namespace trackbed::apps {
namespace {

constexpr int kMonitorSteps = 100;     // between looks at limits and state
constexpr int kWatchSteps = 10;        // between looks at the porosity of a bed to be stopped
constexpr double kSampleTime = 5e-3;   // between lines of history in a stage without cycles [s]
constexpr double kShareOfLimit = 0.9;  // of the measured limit at which the step is halved

void set_step(Run& run, double dt) {
  run.stage.dt = dt;
  coupling::set_step(run.world, dt);
}

// A priori: margin times the limit of the stiffest contact to expect; whole steps a cycle.
void choose_step(Run& run, const Stage& stage) {
  const NumericsScene& n = run.scene.numerics;
  dem::TimeStepLimit limit =
      dem::expected_limit(run.world.bodies, run.world.shapes, run.world.materials, {});
  const dem::TimeStepLimit now = coupling::measured_limit(run.world, run.threads);
  double dt = stage.margin * std::min(limit.dt, 2 / now.omega);
  const int per_exchange = coupling::steps_per_exchange(run.world);
  if (per_exchange > 1 && dt > now.dt) {
    char text[240];
    std::snprintf(text, sizeof text,
                  "Numerics/Grain steps per exchange: %d steps of %.3g s are over the stability "
                  "limit of grains on the surfaces in stage '%s' (%.3g s); %d would do",
                  per_exchange, dt, stage.name.c_str(), per_exchange * now.dt,
                  std::max(1, static_cast<int>(kShareOfLimit * per_exchange * now.dt / dt)));
    throw InputError(text);
  }
  dt = std::min(dt, coupling::schedule_limit(run.world));
  if (n.step_rule != "tangent" && n.time_step == 0) {
    const double by_rule =
        dem::rule_of_thumb(n.step_rule, run.world.bodies, run.world.shapes, run.world.materials);
    if (by_rule > std::min(limit.dt, now.dt)) {
      char text[240];
      std::snprintf(text, sizeof text,
                    "Numerics/Time step rule: '%s' gives %.3g s, over the stability limit of stage "
                    "'%s' (%.3g s); 'tangent' would take %.3g s",
                    n.step_rule.c_str(), by_rule, stage.name.c_str(), std::min(limit.dt, now.dt),
                    dt);
      throw InputError(text);
    }
    dt = by_rule;
  }
  for (const coupling::Surface& s : run.world.surfaces)
    dt = std::min(dt, 0.99 * s.structure->largest_step() / per_exchange);
  if (n.time_step > 0) {
    if (n.time_step > std::min(limit.dt, now.dt) && !is_replay(run.scene)) {
      char text[200];
      std::snprintf(text, sizeof text,
                    "Numerics/Time step: %.3g s is over the stability limit of stage '%s' "
                    "(%.3g s); %.3g s would do",
                    n.time_step, stage.name.c_str(), std::min(limit.dt, now.dt), dt);
      throw InputError(text);
    }
    dt = n.time_step;
  }
  run.stage.steps_per_cycle = 0;
  if (stage.period > 0) {
    const int samples = 2 * std::max(1, run.scene.output.samples_per_cycle / 2);
    // Whole exchanges between samples.
    const int exchanges = static_cast<int>(std::ceil(stage.period / dt / samples / per_exchange));
    run.stage.steps_per_cycle = exchanges * per_exchange * samples;
    dt = stage.period / run.stage.steps_per_cycle;
  }
  set_step(run, dt);
}

// By the scene, or in a packing that was taken from files.
bool has_round_grains(const Run& run) {
  const Scene& s = run.scene;
  if (has_shape(s, "sphere") || has_shape(s, "clump") || has_shape(s, "dilated")) return true;
  const dem::ShapeTable& shapes = run.world.shapes;
  for (int k = 0; k < shapes.size(); ++k)
    for (const dem::ConvexPart& part : shapes.shape(k).parts)
      if (part.radius > 0) return true;
  return false;
}

void choose_laws(Run& run, const Stage& stage) {
  coupling::World& w = run.world;
  const ContactScene& c = run.scene.contact;
  w.materials = make_materials(run.scene, stage.modulus, run.stage.friction);
  w.pair_forces = dem::make_pair_forces(c.law, true);
  w.patch_forces = dem::make_patch_forces(c.law, true);
  if (has_round_grains(run)) {
    w.round_forces = dem::make_round_forces(c.round_law, true);
    w.round_patch_forces = dem::make_round_patch_forces(c.round_law, true);
  }
  w.resistance = {c.torsion, c.rolling};
  w.adaptive = c.damping_kind == "adaptive";
}

void enter(Run& run, const Stage& stage) {
  run.stage.friction = stage.friction;
  run.stage.stop_at = 0;
  stage.enter(run);
  choose_laws(run, stage);
  run.world.adaptive_damping = {};
  StageState& s = run.stage;
  s.steps = s.cycles = s.halvings = 0;
  s.start = run.world.time;
  s.grain_force.resize(run.world.bodies.grains, 0.0);
  apply_load(run, stage.load(run, 0));
  // Positions, not motion: forces where everything stands.
  s.dt = 0;
  coupling::prepare(run.world, step_context(run, stage));
  choose_step(run, stage);
  if (stage.ledger) {
    if (run.scene.numerics.mirror_noise > 0)
      run.world.bodies.x[0] *= 1 + run.scene.numerics.mirror_noise;
    coupling::open_ledger(run.world, step_context(run, stage).gravity);
    s.work_in = s.last_work = s.worst_closure = s.exchange_gain = s.pad_work = s.pad_loss = 0;
  }
}

// Looks at limits and overlaps; halves the step when contacts have grown too stiff for it.
void monitor(Run& run, const Stage& stage, Progress& progress) {
  coupling::World& w = run.world;
  StageState& s = run.stage;
  s.largest_overlap =
      std::max(s.largest_overlap, dem::deepest_overlap(w.bodies, w.shapes, w.pairs).share);
  const dem::TimeStepLimit limit = coupling::measured_limit(w, run.threads);
  s.largest_step_share = std::max(s.largest_step_share, s.dt / limit.dt);
  if (s.dt > limit.dt && run.scene.numerics.time_step > 0) {
    char text[240];
    std::snprintf(text, sizeof text,
                  "step %ld: Numerics/Time step: %.3g s is over the stability limit, which fell to "
                  "%.3g s in stage '%s' (body %d); %.3g s would do",
                  w.step, s.dt, limit.dt, stage.name.c_str(), limit.body, stage.margin * limit.dt);
    throw RunError(text);
  }
  if (s.dt > kShareOfLimit * limit.dt && run.scene.numerics.time_step == 0) {
    ++s.halvings;
    s.steps *= 2;
    s.steps_per_cycle *= 2;
    set_step(run, 0.5 * s.dt);
    char text[160];
    std::snprintf(text, sizeof text,
                  "%s: contacts have stiffened, time step halved to %.3g s (limit %.3g s, body %d)",
                  stage.name.c_str(), s.dt, limit.dt, limit.body);
    progress.note(text);
  }
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

bool at_rest(const Run& run, const Stage& stage) {
  const dem::Bodies& b = run.world.bodies;
  double kinetic = 0, weight = 0;
  for (int i = 0; i < b.grains; ++i) {
    kinetic += 0.5 * b.mass[i] * b.v[i].squaredNorm() + 0.5 * b.L[i].dot(b.omega[i]);
    weight += b.mass[i] * 9.81 * run.world.shapes.shape(b.shape[i]).sieve_size;
  }
  return run.world.time - run.stage.start > 0.05 && stage.until_quiet &&
         kinetic < run.scene.packing.quiet * weight &&
         (stage.unbalanced <= 0 ||
          dem::unbalanced_share(b, run.world.pairs, step_context(run, stage).gravity) <
              stage.unbalanced);
}

// What is recorded at the trough and at the peak of a load cycle. True: the stage is over.
bool record_cycle(Run& run, const Stage& stage, Recorder& recorder, const std::string& folder) {
  StageState& s = run.stage;
  const int phase = s.steps % s.steps_per_cycle;
  const bool tamping = run.actors.plate;
  if (!tamping && phase == static_cast<int>(stage.peak * s.steps_per_cycle + 0.5)) {
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

std::string detail(const Run& run) {
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

// The time at which a stage's first step starts: what is zero from here on.
void start_of_stage(Run& run, const Stage& stage, Recorder& recorder) {
  StageState& s = run.stage;
  if (stage.period > 0 && run.actors.plate) recorder.compaction(run);
  if (stage.period > 0 && !run.actors.plate) {
    s.u0 = sleeper_displacement(run);
    s.u_min = 0, s.load_min = s.load;
  }
  recorder.sample(run, stage);
}

// Whether a multiple of `interval` steps was reached with the last `taken` of them.
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

Ending take_stages(Run& run, const std::vector<Stage>& stages, int first_index,
                   const std::string& folder, Recorder& recorder, SnapshotLog& snapshots,
                   Progress& progress, Watch& watch) {
  using Clock = std::chrono::steady_clock;
  StageState& s = run.stage;
  const OutputScene& out = run.scene.output;
  const std::string file = folder + "/checkpoint.h5";
  auto saved = Clock::now();
  bool kept = std::filesystem::exists(file);
  const auto checkpoint = [&] {
    recorder.flush();
    save_run(file, run, {recorder.rows(), snapshots});
    saved = Clock::now();
    kept = true;
  };

  for (int k = s.index - first_index; k < static_cast<int>(stages.size()); ++k) {
    const Stage& stage = stages[k];
    s.index = first_index + k;
    const bool resumed = s.dt > 0 && s.steps > 0;
    if (resumed) {
      choose_laws(run, stage);
      set_step(run, s.dt);
      watch = start_watch(run);
    } else {
      enter(run, stage);
      watch = start_watch(run);
      inspect(run, stage, watch);
      start_of_stage(run, stage, recorder);
    }
    progress.begin(stage.name, run.world.time, s.start + stage.longest);
    const coupling::Drive drive = [&](coupling::World&, double time) {
      const double before = s.load;
      apply_load(run, stage.load(run, time - s.start));
      if (stage.ledger || stage.push) compress_pads(run, before, s.dt);
      if (stage.push) apply_push(run, stage.push(time - s.start));
    };
    const int taken = coupling::steps_per_exchange(run.world);
    bool over = false;
    while (!over) {
      coupling::advance(run.world, step_context(run, stage), drive);
      s.steps += taken;
      if (stage.control) over = stage.control(run, stage);
      const bool look = reached(s, kMonitorSteps, taken);
      if (look) {
        inspect(run, stage, watch);
        monitor(run, stage, progress);
      }
      if (stage.watch && reached(s, kWatchSteps, taken) && stage.watch(run))
        run.world.materials = make_materials(run.scene, stage.modulus, s.friction);
      if (sample_due(s, taken, run.scene)) {
        keep_grain_forces(run);
        recorder.sample(run, stage);
      } else if (out.energy_interval > 0 && reached(s, out.energy_interval, taken))
        recorder.energy(run, stage);
      if (s.steps_per_cycle > 0) {
        over = record_cycle(run, stage, recorder, folder) || over;
        if (s.steps % s.steps_per_cycle == 0) check_ledger(run, stage);
      }
      over = over || (look && at_rest(run, stage)) ||
             run.world.time - s.start > stage.longest - 0.5 * taken * s.dt;
      const bool stop = stop_requested() && !over;
      const std::chrono::duration<double> since = Clock::now() - saved;
      const bool due = out.checkpoint_interval > 0 && since.count() > 60 * out.checkpoint_interval;
      // Nothing is kept that a look would refuse.
      if ((over || stop || due) && !look) inspect(run, stage, watch);
      if (over || snapshot_due(s, taken, out.snapshot_interval))
        write_snapshot(run, stage, folder, out.structure_fields, snapshots);
      if (progress.due()) progress.update(run.world.time, detail(run));
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
    progress.finish(run.world.time, detail(run));
    const bool again = stage.again && stage.again(run);
    if (again) --k;
    s.index = first_index + k + 1;
    s.dt = 0, s.steps = 0;
    checkpoint();
  }
  return Ending::done;
}

// The same message with the pair's own scene, which is written.
[[noreturn]] void give_up(const Run& run, const Stage& stage, const Watch& watch,
                          const dem::StateFault& fault, const std::string& folder) {
  const std::string scene = write_offender(run, stage, watch.before, fault.a, fault.b, folder);
  std::string text = fault.what();
  if (!scene.empty())
    text += " Bodies " + std::to_string(fault.a) + " and " + std::to_string(fault.b) +
            " alone, from the last look before: trackbed run " + scene + ".";
  throw RunError(text);
}

}  // namespace

Ending run_stages(Run& run, const std::vector<Stage>& stages, int first_index,
                  const std::string& folder, Recorder& recorder, SnapshotLog& snapshots,
                  Progress& progress) {
  Watch watch;
  const auto stage = [&]() -> const Stage& {
    const std::size_t k = run.stage.index - first_index;
    return stages[std::min(k, stages.size() - 1)];
  };
  try {
    try {
      return take_stages(run, stages, first_index, folder, recorder, snapshots, progress, watch);
    } catch (const dem::StateFault&) {
      throw;
    } catch (const RunError&) {
      inspect(run, stage(), watch);  // may know which grain it was
      throw;
    }
  } catch (const dem::StateFault& fault) {
    give_up(run, stage(), watch, fault, folder);
  }
}

}  // namespace trackbed::apps
