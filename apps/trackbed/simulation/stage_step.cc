#include "apps/trackbed/simulation/stage_step.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/trackbed/simulation/replay.h"
#include "base/error.h"
#include "coupling/time_step.h"

namespace trackbed::apps {
namespace {

constexpr double kShareOfLimit = 0.9;  // of the measured limit at which the step is halved

// Of a step of `dt` in a stage: what is expected of its contacts, what those there are allow.
struct Limits {
  dem::TimeStepLimit expected, now;
  double least() const { return std::min(expected.dt, now.dt); }
};

void check_exchange(const Stage& stage, const Limits& limits, double dt, int per_exchange) {
  if (per_exchange == 1 || dt <= limits.now.dt) return;
  char text[240];
  std::snprintf(text, sizeof text,
                "Numerics/Grain steps per exchange: %d steps of %.3g s are over the stability "
                "limit of grains on the surfaces in stage '%s' (%.3g s); %d would do",
                per_exchange, dt, stage.name.c_str(), per_exchange * limits.now.dt,
                std::max(1, static_cast<int>(kShareOfLimit * per_exchange * limits.now.dt / dt)));
  throw InputError(text);
}

double step_by_rule(const Run& run, const Stage& stage, const Limits& limits, double tangent) {
  const coupling::World& w = run.world;
  const std::string& rule = run.scene.numerics.step_rule;
  const double dt = dem::rule_of_thumb(rule, w.bodies, w.shapes, w.materials);
  if (dt <= limits.least()) return dt;
  char text[240];
  std::snprintf(text, sizeof text,
                "Numerics/Time step rule: '%s' gives %.3g s, over the stability limit of stage "
                "'%s' (%.3g s); 'tangent' would take %.3g s",
                rule.c_str(), dt, stage.name.c_str(), limits.least(), tangent);
  throw InputError(text);
}

void check_fixed(const Run& run, const Stage& stage, const Limits& limits, double would_do) {
  const double dt = run.scene.numerics.time_step;
  if (dt <= limits.least() || is_replay(run.scene)) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "Numerics/Time step: %.3g s is over the stability limit of stage '%s' "
                "(%.3g s); %.3g s would do",
                dt, stage.name.c_str(), limits.least(), would_do);
  throw InputError(text);
}

}  // namespace

void set_step(Run& run, double dt) {
  run.stage.dt = dt;
  coupling::set_step(run.world, dt);
}

void choose_step(Run& run, const Stage& stage) {
  const NumericsScene& n = run.scene.numerics;
  const coupling::World& w = run.world;
  dem::ContactExpectation expect;
  expect.flat_faces = w.round_forces.flat_faces;
  const Limits limits = {dem::expected_limit(w.bodies, w.shapes, w.materials, expect),
                         coupling::measured_limit(w, run.threads)};
  double dt = stage.margin * std::min(limits.expected.dt, 2 / limits.now.omega);
  const int per_exchange = coupling::steps_per_exchange(w);
  check_exchange(stage, limits, dt, per_exchange);
  dt = std::min(dt, coupling::schedule_limit(w));
  if (n.step_rule != "tangent" && n.time_step == 0) dt = step_by_rule(run, stage, limits, dt);
  for (const coupling::Surface& s : w.surfaces)
    dt = std::min(dt, 0.99 * s.structure->largest_step() / per_exchange);
  if (n.time_step > 0) {
    check_fixed(run, stage, limits, dt);
    dt = n.time_step;
  }
  run.stage.steps_per_cycle = 0;
  if (stage.period > 0) {
    const int samples = 2 * std::max(1, run.scene.output.samples_per_cycle / 2);
    const int exchanges = static_cast<int>(std::ceil(stage.period / dt / samples / per_exchange));
    run.stage.steps_per_cycle = exchanges * per_exchange * samples;
    dt = stage.period / run.stage.steps_per_cycle;
  }
  set_step(run, dt);
}

void watch_step(Run& run, const Stage& stage, Progress& progress) {
  StageState& s = run.stage;
  const bool fixed = run.scene.numerics.time_step > 0;
  const dem::TimeStepLimit limit = coupling::measured_limit(run.world, run.threads);
  s.largest_step_share = std::max(s.largest_step_share, s.dt / limit.dt);
  char text[240];
  if (fixed && s.dt > limit.dt) {
    std::snprintf(text, sizeof text,
                  "step %ld: Numerics/Time step: %.3g s is over the stability limit, which fell to "
                  "%.3g s in stage '%s' (body %d); %.3g s would do",
                  run.world.step, s.dt, limit.dt, stage.name.c_str(), limit.body,
                  stage.margin * limit.dt);
    throw RunError(text);
  }
  if (fixed || s.dt <= kShareOfLimit * limit.dt) return;
  ++s.halvings;
  s.steps *= 2;
  s.steps_per_cycle *= 2;
  set_step(run, 0.5 * s.dt);
  std::snprintf(text, sizeof text,
                "%s: contacts have stiffened, time step halved to %.3g s (limit %.3g s, body %d)",
                stage.name.c_str(), s.dt, limit.dt, limit.body);
  progress.note(text);
}

}  // namespace trackbed::apps
