#include <chrono>

#include "base/error.h"
#include "coupling/world.h"
#include "dem/motion/energy.h"

namespace trackbed::coupling {
namespace {

using dem::Vec3;

// Adds the seconds since construction to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(Clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  double& sum_;
  Clock::time_point start_;
};

// Before a search sorts places that are none.
void check_finite(const World& w) {
  for (int i = 0; i < w.bodies.size(); ++i)
    if (!w.bodies.x[i].allFinite() || !w.bodies.q[i].coeffs().allFinite())
      throw RunError("step " + std::to_string(w.step) + ": the place of body " + std::to_string(i) +
                     " is not a finite number; the time step is probably too large");
}

void find_candidates(World& w, const dem::StepContext& c, bool anew) {
  const bool searched = anew || w.candidates.outdated(w.bodies, w.shapes, c);
  if (searched) {
    check_finite(w);
    w.candidates.rebuild(w.bodies, w.shapes, c, w.pairs);
  }
  const double reach = w.candidates.skin();
  for (Surface& s : w.surfaces)
    if (searched || s.contacts.node_travel - s.contacts.searched_at > 0.5 * reach)
      dem::search_patch(w.bodies, w.shapes, s.patch, c, reach, s.contacts);
}

void contact_forces(World& w, const dem::StepContext& c, bool iterates) {
  {
    Stopwatch watch(w.times.grain_contacts);
    w.pair_forces.evaluate(w.bodies, w.shapes, w.materials, c, w.candidates.travel(), w.pairs);
    if (w.pairs.round() > 0)
      w.round_forces.evaluate(w.bodies, w.shapes, w.materials, c, w.candidates.travel(), w.pairs);
    if (w.resistance.any()) dem::add_resistance(w.resistance, w.bodies, w.materials, c, w.pairs);
    dem::sum_forces(w.pairs, c, w.bodies);
  }
  Stopwatch watch(w.times.surface_contacts);
  for (Surface& s : w.surfaces) {
    if (iterates)
      iterate(w, s, c);
    else
      evaluate_surface(w, s, c);
    dem::sum_patch_forces(s.contacts, w.bodies, s.patch);
  }
}

double friction_loss(const World& w, int threads) {
  double sum = dem::friction_loss(w.pairs, threads);
  for (const Surface& s : w.surfaces)
    for (const double loss : s.contacts.friction_loss) sum += loss;
  return sum;
}

double contact_damping(const World& w, int threads) {
  if (!w.round_forces.evaluate) return 0;
  double sum = dem::viscous_loss(w.pairs, threads);
  for (const Surface& s : w.surfaces)
    for (const double loss : s.contacts.viscous_loss) sum += loss;
  return sum;
}

}  // namespace

void prepare(World& w, const dem::StepContext& c) {
  find_candidates(w, c, true);
  contact_forces(w, c, false);
  for (Surface& s : w.surfaces) {
    s.last_force = s.given = s.patch.force;
    std::fill(s.owed.begin(), s.owed.end(), dem::Vec3::Zero());
    s.owed_before = s.owed;
  }
}

void advance(World& w, const dem::StepContext& c, const Drive& drive) {
  const Exchange& e = w.exchange;
  const int steps = steps_per_exchange(w);
  const double duration = steps * c.dt;
  for (int k = 1; k <= steps; ++k) {
    dem::StepWork work;
    {
      Stopwatch watch(w.times.motion);
      work = dem::drift(w.bodies, c);
    }
    w.time += c.dt;
    ++w.step;
    drive(w, w.time);
    {
      Stopwatch watch(w.times.structures);
      for (Surface& s : w.surfaces) {
        if (k == 1) foresee(s, e, duration);
        follow(s, k < steps ? static_cast<double>(k) / steps : 1, c);
      }
    }
    {
      Stopwatch watch(w.times.candidates);
      find_candidates(w, c, false);
    }
    contact_forces(w, c, e.schedule == Schedule::iterated);
    {
      Stopwatch watch(w.times.structures);
      for (Surface& s : w.surfaces) {
        tally(s, e, c);
        if (k == steps) answer(s, e, duration);
      }
    }
    Stopwatch watch(w.times.motion);
    work += dem::kick(w.bodies, c);
    if (w.adaptive) work.local_damping += dem::damp(w.adaptive_damping, w.bodies, c);
    w.flows.work += work.applied;
    w.flows.prescribed += work.prescribed;
    w.flows.local_damping += work.local_damping;
    w.flows.friction += friction_loss(w, c.threads);
    w.flows.contact_damping += contact_damping(w, c.threads);
    ++w.times.steps;
  }
}

}  // namespace trackbed::coupling
