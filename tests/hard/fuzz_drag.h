// Grains of fuzz_surface dragged over their surface: friction and damping, which have a past.
#pragma once
#include <array>

#include "tests/hard/fuzz_laid.h"

namespace trackbed::dem::test {

/// How a grain and its surface move, step by step (dt = 1 s): from a tenth of the depth, where
/// friction holds, to across elements, where it slides. The grain comes up at times, never down.
struct Drag {
  static constexpr int kSteps = 8;
  double friction, damping;
  std::array<Vec3, kSteps> way, turn, ground;
  double jolt;  ///< of each node by itself, as far as it may go [m]
};

inline Drag any_drag(Random& random, const Case& c) {
  Drag d;
  d.friction = std::pow(10., random.uniform(-1.5, .5));
  d.damping = c.plain || random.below(2) ? 0 : random.uniform(.1, .9);
  const double low = std::log10(c.depth) - 1;
  const double reach = std::pow(10., random.uniform(low, std::max(low, -.5)));
  const Vec3 &up = c.ground.up, along = up.cross(random.direction()).normalized();
  for (int k = 0; k < Drag::kSteps; ++k) {
    const double most = reach / Drag::kSteps;
    const auto about = [&] { return random.uniform(-most, most) * up.cross(random.direction()); };
    d.ground[k] = random.below(2) ? about() : Vec3(Vec3::Zero());
    d.way[k] = d.ground[k] + most * along + about() + random.uniform(0, .05) * c.depth * up;
    d.turn[k] =
        random.uniform(0, .02) * std::min(1., c.depth / c.grain.radius) * random.direction();
  }
  d.jolt = c.ground.bent ? 1e-3 * c.depth : 0;
  return d;
}

/// The scene of a case under way, with friction.
struct Dragged : OnGround {
  Dragged(const Case& c, const Ground& g, const Drag& d) : OnGround(c, g) {
    PairMaterial m = materials(0, 0);
    m.friction = d.friction, m.damping = d.damping;
    materials.set(0, 0, m);
    law = c.plain ? make_patch_forces(c.law, true) : make_round_patch_forces(c.law, true);
    answer(c.x, c.R);
  }
  /// Step k of the drag; nodes by themselves as `random` has it.
  Answer step(const Drag& d, int k, Random& random) {
    const double before = travel[0];
    test::place(bodies, 0, bodies.x[0] + d.way[k], rotation(d.turn[k]) * bodies.R[0]);
    bodies.v[0] = d.way[k], bodies.turn[0] = d.turn[k];
    travel[0] = before + d.way[k].norm() + shapes.shape(0).radius * d.turn[k].norm();
    double most = 0;
    for (int i = 0; i < patch.carried; ++i) {
      const Vec3 way = d.ground[k] + random.uniform(0, d.jolt) * random.direction();
      patch.node[i] += way, patch.velocity[i] = way;
      most = std::max(most, way.norm());
    }
    move_skirt(patch);
    contacts.node_travel += most;
    search_patch(bodies, shapes, patch, context, skin, contacts);
    evaluate(1);
    return {bodies.force[0], bodies.torque[0], energy()};
  }
};

}  // namespace trackbed::dem::test
