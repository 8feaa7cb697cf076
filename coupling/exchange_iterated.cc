#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "coupling/exchange.h"
#include "coupling/world.h"

namespace trackbed::coupling {
namespace {

using dem::Vec3;

// What the contacts remember from step to step.
struct History {
  std::vector<Vec3> friction, arm;
  std::vector<double> friction_stiffness, viscous;
  std::vector<std::uint8_t> touching;
};

History history_of(const dem::PatchContacts& k) {
  return {k.friction, k.arm, k.friction_stiffness, k.viscous, k.touching};
}

void put_back(const History& h, dem::PatchContacts& k) {
  k.friction = h.friction, k.arm = h.arm;
  k.friction_stiffness = h.friction_stiffness, k.touching = h.touching;
  k.viscous = h.viscous;
}

double deepest(const dem::PatchContacts& k) {
  double depth = 0;
  for (int i = 0; i < k.size(); ++i)
    if (k.touching[i]) depth = std::max(depth, k.depth[i]);
  return depth;
}

// Aitken's factor (Irons, Tuck 1969) for residuals `old` and `now`; kept within 0.1 and 1, and as
// it was where the residual did not change.
double relaxation(double factor, const std::vector<Vec3>& old, const std::vector<Vec3>& now) {
  double above = 0, below = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Vec3 change = now[i] - old[i];
    above -= old[i].dot(change);
    below += change.squaredNorm();
  }
  if (!(below > 0)) return factor;
  return std::min(1.0, std::max(0.1, factor * above / below));
}

}  // namespace

// The grains are where they are at the step's end and do not move here, so each surface iterates
// on its own. `follow` has moved the nodes to the prediction.
void iterate(World& w, Surface& s, const dem::StepContext& c) {
  const History before = history_of(s.contacts);
  const int n = s.patch.carried;
  std::vector<double> state;
  s.structure->save(state);
  std::vector<Vec3> start(n), residual(n), old(n);
  for (int i = 0; i < n; ++i) start[i] = s.patch.node[i] - c.dt * s.patch.velocity[i];

  double factor = 1, remains = 0;
  for (int k = 0; k < w.exchange.most_iterations; ++k) {
    if (k > 0) put_back(before, s.contacts);
    evaluate_surface(w, s, c);
    dem::sum_node_forces(s.contacts, s.patch);
    for (int i = 0; i < n; ++i) {
      const Vec3& f = s.patch.force[i];
      s.forces[i] = {f[0], f[1], f[2]};
    }
    s.structure->advance(s.forces);
    s.structure->motion(s.displacement, s.velocity);
    s.structure->load(state);
    ++w.times.iterations;

    const fem::SurfaceMesh& mesh = s.structure->surface();
    remains = 0;
    for (int i = 0; i < n; ++i) {
      for (int d = 0; d < 3; ++d)
        residual[i][d] = mesh.nodes[i][d] + s.displacement[i][d] - s.patch.node[i][d];
      remains = std::max(remains, residual[i].norm());
    }
    const double depth = deepest(s.contacts);
    if (k > 0 && (depth == 0 || remains <= w.exchange.tolerance * depth)) return;

    if (k > 0) factor = relaxation(factor, old, residual);
    old = residual;
    double farthest = 0;
    for (int i = 0; i < n; ++i) {
      s.patch.node[i] += factor * residual[i];
      s.patch.velocity[i] = (s.patch.node[i] - start[i]) / c.dt;
      farthest = std::max(farthest, residual[i].norm());
    }
    dem::move_skirt(s.patch);
    s.contacts.node_travel += factor * farthest;
  }
  char text[320];
  std::snprintf(text, sizeof text,
                "step %ld: the exchange with the %s did not converge in %d iterations (it still "
                "moves by %.2g m); the time step is probably too large, or a static structure much "
                "softer than its contacts",
                w.step, s.patch.name.c_str(), w.exchange.most_iterations, remains);
  throw RunError(text);
}

}  // namespace trackbed::coupling
