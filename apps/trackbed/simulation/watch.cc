#include "apps/trackbed/simulation/watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/trackbed/decide.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/replay.h"
#include "base/error.h"
#include "dem/motion/energy.h"
#include "dem/surface/penetration.h"

namespace trackbed::apps {
namespace {

constexpr double kFactor = 3;  // on the speed that can be explained: grains that push each other

// Plate or rigid sleeper, and the nodes of deforming surfaces.
double fastest_driven(const Run& run) {
  const coupling::World& w = run.world;
  double most = 0;
  for (int i = w.bodies.grains; i < w.bodies.size(); ++i)
    most = std::max(most, w.bodies.v[i].norm());
  for (const coupling::Surface& s : w.surfaces)
    for (const dem::Vec3& v : s.patch.velocity) most = std::max(most, v.norm());
  return most;
}

double strongest_contact(const Run& run) {
  const coupling::World& w = run.world;
  double most = 0;
  for (const double u : w.pairs.energy) most = std::max(most, u);
  for (const coupling::Surface& s : w.surfaces)
    for (const double u : s.contacts.energy) most = std::max(most, u);
  return most;
}

dem::StateLimits limits(const Run& run, const Watch& watch, const dem::Vec3& gravity) {
  dem::StateLimits l;
  l.overlap = run.scene.contact.largest_overlap;
  const double given = run.scene.numerics.largest_speed;
  l.speed = {given, 0};
  if (given == 0) {
    const double known = std::sqrt(2 * gravity.norm() * watch.fall) + watch.driven;
    l.speed = {kFactor * known, kFactor * kFactor * watch.energy};
  }
  if (is_replay(run.scene)) return l;
  const Layout& box = run.layout;
  const dem::Vec3 room = dem::Vec3::Constant(0.3);
  l.region.low = box.low - room, l.region.high = box.high + room;
  if (run.scene.test.type == "angle_of_repose") l.region.high.x() += run.scene.test.floor_length;
  l.region.high.z() = HUGE_VAL;
  for (int k = 0; k < 2; ++k)
    if (box.period[k] > 0) l.region.low[k] = -HUGE_VAL, l.region.high[k] = HUGE_VAL;
  return l;
}

std::string when(const Run& run, const Stage& stage) {
  char text[100];
  std::snprintf(text, sizeof text, "%s, %.6g s", stage.name.c_str(), run.world.time);
  return text;
}

void check_surfaces(const Run& run, const Stage& stage) {
  const coupling::World& w = run.world;
  const double allowed = run.scene.contact.largest_overlap;
  for (std::size_t n = 0; n < w.surfaces.size(); ++n) {
    const coupling::Surface& s = w.surfaces[n];
    for (int k = 0; k < s.contacts.size(); ++k) {
      if (!s.contacts.touching[k]) continue;
      const int i = s.contacts.grain[k];
      const double size = std::cbrt(w.shapes.shape(w.bodies.shape[i]).volume);
      if (s.contacts.depth[k] <= allowed * size) continue;
      const double depth = dem::penetration(w.bodies, w.shapes, s.contacts, k),
                   share = depth / size;
      if (share <= allowed) continue;
      char text[400];
      std::snprintf(text, sizeof text,
                    "step %ld (%s): grain %d and the %s overlap by %.3g m, %.3g %% of the grain's "
                    "size (allowed %.3g %%). Likely cause: the contact modulus is too soft for the "
                    "load, or the time step %.3g s is too large. Remedy: a larger "
                    "Contact/Contact modulus, or a smaller Numerics/Margin.",
                    w.step, when(run, stage).c_str(), i, s.patch.name.c_str(), depth, 100 * share,
                    100 * allowed, run.stage.dt);
      throw SurfaceFault(text, i, static_cast<int>(n), k);
    }
  }
}

// One that slid off a small bed lies beside it.
void check_sleeper(const Run& run, const Stage& stage) {
  if (run.actors.sleeper_surface < 0 && !run.actors.rigid_sleeper) return;
  const double base = run.actors.sleeper_base - sleeper_displacement(run);
  if (base >= 0) return;
  char text[300];
  std::snprintf(
      text, sizeof text,
      "step %ld (%s): the sleeper has left the bed, its base is %.3g m below the "
      "subgrade's top. Likely cause: the bed is too narrow for it or loose, and it tipped. "
      "Remedy: a wider Container, Container/Fill height, or Sleeper/Degrees of freedom = "
      "vertical.",
      run.world.step, when(run, stage).c_str(), -base);
  throw RunError(text);
}

}  // namespace

Watch start_watch(const Run& run) {
  Watch watch;
  const dem::Bodies& b = run.world.bodies;
  watch.before = b;
  watch.before_time = run.world.time;
  watch.fall = std::max(0.0, highest_grain(run, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL));
  watch.driven = fastest_driven(run);
  for (int i = 0; i < b.grains; ++i) watch.driven = std::max(watch.driven, b.v[i].norm());
  watch.energy = strongest_contact(run);
  return watch;
}

void inspect(const Run& run, const Stage& stage, Watch& watch) {
  const coupling::World& w = run.world;
  const dem::StepContext c = step_context(run, stage);
  watch.driven = std::max(watch.driven, fastest_driven(run));
  dem::check_state(w.bodies, w.shapes, w.pairs, c, w.step, limits(run, watch, c.gravity),
                   when(run, stage));
  check_surfaces(run, stage);
  check_sleeper(run, stage);
  watch.energy = std::max(watch.energy, strongest_contact(run));
  watch.before = w.bodies;
  watch.before_time = w.time;
}

void check_ledger(const Run& run, const Stage& stage) {
  const StageState& s = run.stage;
  const coupling::World& w = run.world;
  const double allowed = run.scene.numerics.closure;
  double put_in = s.work_in;
  if (stage.ledger && stage.control)
    put_in += std::max(
        0.0, w.start.gravity - dem::gravity_energy(w.bodies, step_context(run, stage).gravity));
  if (!stage.ledger || !(put_in > 0)) return;
  const struct {
    double amount;
    const char *what, *remedy;
  } gaps[] = {{s.exchange_gain, "the exchange with the structures made",
               "Its steps are too long, or it is lagged: a smaller Numerics/Margin, "
               "Numerics/Exchange = predicted or iterated, or fewer grain steps per exchange."},
              {s.structure_gain, "the structures' time integration made",
               "Its steps are too long for the structures: another Numerics/Structure scheme, or a "
               "smaller Numerics/Margin."},
              {s.worst_closure, "the energy ledger is open by",
               "The time step is probably too large for the contacts: halve Numerics/Margin or "
               "Numerics/Time step."}};
  // Of what the ledger as a whole is open by, the parts are told first.
  const auto* first = std::begin(gaps);
  const auto* last = std::end(gaps) - (stores_energy(run.scene) ? 0 : 1);
  const auto* gap =
      std::find_if(first, last, [&](const auto& g) { return g.amount > allowed * put_in; });
  if (gap == last) return;
  const dem::Deepest deepest = dem::deepest_overlap(w.bodies, w.shapes, w.pairs);
  const int a = deepest.pair < 0 ? -1 : w.pairs.a[deepest.pair];
  const int b = deepest.pair < 0 ? -1 : w.pairs.b[deepest.pair];
  char pair[120] = "";
  if (a >= 0)
    std::snprintf(pair, sizeof pair, " The deepest contact is that of bodies %d and %d, %.2g m.", a,
                  b, w.pairs.depth[deepest.pair]);
  char text[600];
  std::snprintf(text, sizeof text,
                "step %ld (%s): %s %.3g J, %.2g %% of the %.3g J put in; Numerics/Closure "
                "allows %.2g %%. %s%s",
                w.step, when(run, stage).c_str(), gap->what, gap->amount,
                100 * gap->amount / put_in, put_in, 100 * allowed, gap->remedy, pair);
  throw dem::StateFault(text, a, b);
}

}  // namespace trackbed::apps
