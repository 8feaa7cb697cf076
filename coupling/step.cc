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

Vec3 vec(const fem::Vec& v) { return {v[0], v[1], v[2]}; }

// Surface nodes to where the structure expects them at t + dt.
void predict(Surface& s, const dem::StepContext& c) {
  s.structure->predict(s.displacement, s.velocity);
  const fem::SurfaceMesh& mesh = s.structure->surface();
  double fastest = 0;
  for (int i = 0; i < s.patch.carried; ++i) {
    const Vec3 place = vec(mesh.nodes[i]) + vec(s.displacement[i]);
    s.patch.velocity[i] = (place - s.patch.node[i]) / c.dt;
    s.patch.node[i] = place;
    fastest = std::max(fastest, s.patch.velocity[i].squaredNorm());
  }
  dem::move_skirt(s.patch);
  s.contacts.node_travel += std::sqrt(fastest) * c.dt;
}

// The forces found at the predicted surface, to the structure; their work along the predicted
// motion, for the ledger.
void answer(Surface& s, const dem::StepContext& c) {
  for (int i = 0; i < s.patch.carried; ++i) {
    const Vec3& f = s.patch.force[i];
    s.work_predicted += 0.5 * c.dt * s.patch.velocity[i].dot(f + s.last_force[i]);
    s.forces[i] = {f[0], f[1], f[2]};
  }
  s.last_force = s.patch.force;
  s.structure->advance(s.forces);
}

void find_candidates(World& w, const dem::StepContext& c, bool anew) {
  if (anew) w.candidates.rebuild(w.bodies, w.shapes, c, w.pairs);
  const bool searched = anew || w.candidates.update(w.bodies, w.shapes, c, w.pairs);
  const double reach = w.candidates.skin();
  for (Surface& s : w.surfaces)
    if (searched || s.contacts.node_travel - s.contacts.searched_at > 0.5 * reach)
      dem::search_patch(w.bodies, w.shapes, s.patch, c, reach, s.contacts);
}

void contact_forces(World& w, const dem::StepContext& c) {
  {
    Stopwatch watch(w.times.grain_contacts);
    w.pair_forces.evaluate(w.bodies, w.shapes, w.materials, c, w.candidates.travel(), w.pairs);
    dem::sum_forces(w.pairs, c, w.bodies);
  }
  Stopwatch watch(w.times.surface_contacts);
  for (Surface& s : w.surfaces) {
    w.patch_forces(w.bodies, w.shapes, w.materials, c, w.candidates.travel(), s.patch, s.contacts);
    dem::sum_patch_forces(s.contacts, w.bodies, s.patch);
  }
}

double friction_loss(const World& w, int threads) {
  double sum = dem::friction_loss(w.pairs, threads);
  for (const Surface& s : w.surfaces)
    for (const double loss : s.contacts.friction_loss) sum += loss;
  return sum;
}

}  // namespace

void prepare(World& w, const dem::StepContext& c) {
  find_candidates(w, c, true);
  contact_forces(w, c);
  for (Surface& s : w.surfaces) s.last_force = s.patch.force;
}

void advance(World& w, const dem::StepContext& c, const Drive& drive) {
  dem::StepWork work;
  {
    Stopwatch watch(w.times.motion);
    work = dem::drift(w.bodies, c);
  }
  w.time += c.dt;
  ++w.step;
  check_finite(w);
  drive(w, w.time);
  {
    Stopwatch watch(w.times.structures);
    for (Surface& s : w.surfaces) predict(s, c);
  }
  {
    Stopwatch watch(w.times.candidates);
    find_candidates(w, c, false);
  }
  contact_forces(w, c);
  {
    Stopwatch watch(w.times.structures);
    for (Surface& s : w.surfaces) answer(s, c);
  }
  Stopwatch watch(w.times.motion);
  work += dem::kick(w.bodies, c);
  w.flows.work += work.applied;
  w.flows.prescribed += work.prescribed;
  w.flows.local_damping += work.local_damping;
  w.flows.friction += friction_loss(w, c.threads);
  ++w.times.steps;
}

}  // namespace trackbed::coupling
