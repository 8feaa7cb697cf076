#include <algorithm>
#include <cmath>

#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/quasi_vibration.h"
#include "apps/trackbed/simulation/replay.h"
#include "apps/trackbed/simulation/stage.h"
#include "apps/trackbed/simulation/structures.h"
#include "apps/trackbed/waveform.h"

namespace trackbed::apps {
namespace {

Stage packing_stage(const Scene& s, const char* name) {
  Stage stage;
  stage.name = name;
  stage.modulus = s.contact.packing_modulus;
  stage.damping = s.contact.packing_damping;
  stage.margin = s.numerics.packing_margin;
  stage.friction = s.packing.packing_friction >= 0 ? s.packing.packing_friction : s.grains.friction;
  stage.longest = s.packing.settle_time;
  stage.until_quiet = true;
  stage.load = [](const Run&, double) { return 0.0; };
  stage.enter = [](Run&) {};
  return stage;
}

}  // namespace

Stage bed_stage(const Scene& s, const std::string& name, double longest, double damping) {
  Stage stage;
  stage.name = name;
  stage.modulus = s.contact.modulus;
  stage.damping = damping;
  stage.margin = s.numerics.margin;
  stage.friction = s.grains.friction;
  stage.longest = longest;
  stage.ledger = true;
  stage.load = [](const Run&, double) { return 0.0; };
  stage.enter = [](Run&) {};
  return stage;
}

std::vector<Stage> packing_stages(const Scene& s) {
  std::vector<Stage> stages;
  if (is_replay(s)) return stages;

  const bool vibrated = s.packing.method == "quasi_vibration";
  const bool layered = s.packing.layers * s.packing.bays > 1;
  Stage deposit = packing_stage(s, "deposit");
  if (vibrated) deposit.friction = s.packing.friction_path.front();
  if (vibrated) deposit.unbalanced = s.packing.unbalanced;
  deposit.enter = [](Run& run) {
    const double mass = run.layout.bed_mass / run.scene.packing.layers;
    if (!run.scene.packing.start_from.empty())
      place_imported(run);
    else
      pour_grains(run, draw_batch(run, mass, 0, false), false);
    add_walls(run);
  };
  stages.push_back(deposit);

  if (vibrated) {
    Stage path = packing_stage(s, "quasi-vibration");
    path.unbalanced = s.packing.unbalanced;
    path.enter = begin_trial;
    path.watch = stop_bed;
    path.again = trial_follows;
    stages.push_back(path);
  }

  if (s.packing.method == "tamping" && s.packing.plate_cycles > 0) {
    Stage tamping = packing_stage(s, "tamping");
    tamping.until_quiet = false;
    tamping.period = 1 / s.packing.plate_frequency;
    tamping.longest = s.packing.plate_cycles * tamping.period;
    tamping.enter = [](Run& run) { add_plate(run); };
    tamping.load = [](const Run& run, double t) {
      const PackingScene& p = run.scene.packing;
      return waveform_load("sine", t, 1 / p.plate_frequency, 0, p.plate_force);
    };
    if (s.packing.target_density > 0) tamping.aim = "Packing/Target density";
    tamping.after_cycle = [](Run& run) {
      const double target = run.scene.packing.target_density;
      return target > 0 && bed_density(run) >= target;
    };
    stages.push_back(tamping);
  }

  if (layered) {
    Stage seams = packing_stage(s, "layers");
    seams.unbalanced = s.packing.unbalanced;
    seams.enter = [](Run& run) {
      if (run.actors.plate) remove_moving_body(run);
      duplicate_sample(run);
      // The friction that made the sample makes the seams as dense.
      if (!run.path.empty()) run.stage.friction = bed_friction(run);
    };
    stages.push_back(seams);
  }

  // A test of grains has no sleeper: what it needs besides grains it puts in itself.
  Stage fill = packing_stage(s, s.test.on() ? "rest" : "sleeper in");
  if (vibrated) fill.friction = s.grains.friction;
  fill.enter = [](Run& run) {
    if (run.actors.plate) remove_moving_body(run);
    if (run.scene.test.on()) return;
    trim_shoulders(run);
    if (run.layout.fill_mass > 0)
      pour_grains(run, draw_batch(run, run.layout.fill_mass, 1, true), true);
    add_rigid_sleeper(run);
  };
  stages.push_back(fill);

  Stage harden = packing_stage(s, "hardening");
  harden.modulus = s.contact.modulus;
  harden.friction = s.grains.friction;
  harden.margin = s.numerics.margin;
  harden.longest = 0.25 * s.packing.settle_time;
  harden.enter = [](Run& run) { trim_shoulders(run); };
  stages.push_back(harden);
  return stages;
}

std::vector<Stage> loading_stages(const Scene& s) {
  if (is_replay(s)) return {replay_stage(s)};
  if (s.test.on()) return grain_test_stages(s);
  Stage seating = bed_stage(s, "seating", 2 * s.loading.ramp_time, s.contact.packing_damping);
  seating.enter = [](Run& run) { place_structures(run); };
  seating.load = [](const Run& run, double t) {
    const LoadingScene& l = run.scene.loading;
    return l.least * std::min(1.0, l.ramp_time > 0 ? t / l.ramp_time : 1);
  };

  Stage loading = seating;
  loading.name = "loading";
  loading.goes_on = true;
  loading.damping = s.contact.damping;
  loading.period = 1 / s.loading.frequency;
  loading.longest = s.loading.cycles * loading.period;
  loading.enter = [](Run&) {};
  loading.load = [](const Run& run, double t) {
    const LoadingScene& l = run.scene.loading;
    return waveform_load(l.waveform, t, 1 / l.frequency, l.least, l.largest);
  };
  if (s.loading.waveform == "table") {
    loading.peak = s.loading.history.peak();
    loading.load = [](const Run& run, double t) { return run.scene.loading.history.at(t); };
  }
  if (s.loading.push == "none") return {seating, loading};

  Stage push = seating;
  push.name = "push";
  push.goes_on = true;
  push.damping = s.contact.damping;
  push.longest = s.loading.push_distance / s.loading.push_speed;
  push.ledger = false;
  push.enter = [](Run& run) { run.stage.push_start = push_displacement(run), run.stage.push = 0; };
  push.load = [](const Run& run, double) { return run.scene.loading.least; };
  push.push = [speed = s.loading.push_speed](double t) { return speed * t; };
  return {seating, loading, push};
}

dem::StepContext step_context(const Run& run, const Stage& stage) {
  dem::StepContext c;
  c.dt = run.stage.dt;
  if (!stage.gravity) c.gravity.setZero();
  c.local_damping = run.scene.contact.damping_kind == "local" ? stage.damping : 0;
  c.period = run.layout.period;
  // Handing out work costs microseconds: a thread for every hundred grains at most. The answer does
  // not depend on it.
  c.threads = std::min(run.threads, 1 + run.world.bodies.grains / 100);
  return c;
}

double sleeper_displacement(const Run& run) {
  const coupling::World& w = run.world;
  if (run.actors.sleeper_surface >= 0) {
    const fem::Structure& s = *w.surfaces[run.actors.sleeper_surface].structure;
    double sum = 0;
    const int seats = seat_loads(run.scene);
    for (int k = 0; k < seats; ++k) sum -= s.load_displacement(k)[2];
    return sum / seats;
  }
  return run.actors.sleeper_start - w.bodies.x[moving_body(run)].z();
}

double bed_height(const Run& run) {
  const double plate = run.world.bodies.x[moving_body(run)].z();
  return plate - 0.5 * run.scene.packing.plate_thickness;
}

double bed_density(const Run& run) {
  double mass = 0;
  for (int i = 0; i < run.world.bodies.grains; ++i) mass += run.world.bodies.mass[i];
  return mass / (run.layout.area * bed_height(run));
}

}  // namespace trackbed::apps
