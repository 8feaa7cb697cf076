#include "coupling/exchange.h"

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "coupling/world.h"

namespace trackbed::coupling {
namespace {

using dem::Vec3;

constexpr double kPaid = 0.5;  // share of the impulse owed that an exchange pays

Vec3 vec(const fem::Vec& v) { return {v[0], v[1], v[2]}; }

// The cubic through place and velocity at both ends: u + tau v + 1/2 tau^2 a where the structure
// predicts so.
double on_path(double t, double H, double u0, double v0, double u1, double v1) {
  const double t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * u0 + (t3 - 2 * t2 + t) * H * v0 + (3 * t2 - 2 * t3) * u1 +
         (t3 - t2) * H * v1;
}

}  // namespace

const std::vector<ScheduleName>& schedules() {
  static const std::vector<ScheduleName> all{
      {Schedule::predicted, "predicted",
       "each step, at the surface's predicted place; one force on both sides"},
      {Schedule::both_explicit, "explicit",
       "each step, structures by velocity Verlet too (lumped mass, no damping)"},
      {Schedule::several_steps, "several_steps",
       "after several grain steps along the predicted path; impulse kept"},
      {Schedule::iterated, "iterated", "each step, iterated until place and force agree"},
      {Schedule::lagged, "lagged", "each step, a step late: unstable, to show what that does"}};
  return all;
}

Schedule schedule_named(const std::string& name) {
  std::string names;
  for (const ScheduleName& s : schedules()) {
    if (s.name == name) return s.schedule;
    names += (names.empty() ? "" : ", ") + s.name;
  }
  throw InputError("exchange schedule '" + name + "' is not known; there are " + names);
}

int steps_per_exchange(const World& w) { return w.surfaces.empty() ? 1 : w.exchange.grain_steps; }

double schedule_limit(const World& w) {
  double limit = std::numeric_limits<double>::infinity();
  if (w.exchange.schedule != Schedule::both_explicit) return limit;
  for (const Surface& s : w.surfaces) {
    const double own = s.structure->explicit_limit();
    if (!(own > 0))
      throw InputError("exchange schedule 'explicit': the " + s.patch.name +
                       " cannot go without a solve; it needs lumped mass and no damping");
    limit = std::min(limit, own);
  }
  return limit;
}

void set_step(World& w, double dt) {
  const double limit = schedule_limit(w);
  if (dt > limit) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "exchange schedule 'explicit': a step of %.3g s is over the structures' limit; "
                  "%.3g s would do",
                  dt, limit);
    throw InputError(text);
  }
  for (Surface& s : w.surfaces) s.structure->set_step(w.exchange.grain_steps * dt);
}

void foresee(Surface& s, const Exchange& e, double duration) {
  s.duration = duration;
  if (e.schedule == Schedule::lagged) {
    s.structure->motion(s.displacement, s.velocity);
    return;
  }
  if (e.grain_steps > 1) s.structure->motion(s.displacement_before, s.velocity_before);
  s.structure->predict(s.displacement, s.velocity);
}

void follow(Surface& s, double share, const dem::StepContext& c) {
  const fem::SurfaceMesh& mesh = s.structure->surface();
  double fastest = 0;
  for (int i = 0; i < s.patch.carried; ++i) {
    fem::Vec u = s.displacement[i];
    if (share < 1)
      for (int d = 0; d < 3; ++d)
        u[d] = on_path(share, s.duration, s.displacement_before[i][d], s.velocity_before[i][d],
                       u[d], s.velocity[i][d]);
    const Vec3 place = vec(mesh.nodes[i]) + vec(u);
    s.patch.velocity[i] = (place - s.patch.node[i]) / c.dt;
    s.patch.node[i] = place;
    fastest = std::max(fastest, s.patch.velocity[i].squaredNorm());
  }
  dem::move_skirt(s.patch);
  s.contacts.node_travel += std::sqrt(fastest) * c.dt;
}

void tally(Surface& s, const Exchange& e, const dem::StepContext& c) {
  for (int i = 0; i < s.patch.carried; ++i)
    s.work_predicted += 0.5 * c.dt * s.patch.velocity[i].dot(s.patch.force[i] + s.last_force[i]);
  if (e.grain_steps > 1)
    for (int i = 0; i < s.patch.carried; ++i)
      s.owed[i] += 0.5 * c.dt * (s.patch.force[i] + s.last_force[i]);
  s.last_force = s.patch.force;
}

void answer(Surface& s, const Exchange& e, double duration) {
  if (e.grain_steps > 1) {
    for (int i = 0; i < s.patch.carried; ++i) {
      const Vec3 f = s.patch.force[i] + kPaid / duration * s.owed_before[i];
      s.owed[i] -= 0.5 * duration * (s.given[i] + f);
      s.given[i] = f;
      s.forces[i] = {f[0], f[1], f[2]};
    }
    s.owed_before = s.owed;
  } else {
    for (int i = 0; i < s.patch.carried; ++i) {
      const Vec3& f = s.patch.force[i];
      s.forces[i] = {f[0], f[1], f[2]};
    }
  }
  s.structure->advance(s.forces);
}

}  // namespace trackbed::coupling
