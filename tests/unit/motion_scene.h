// A small scene of bodies for tests and benchmarks: what the run loop does, without structures.
#pragma once
#include <cmath>
#include <functional>

#include "dem/contact/candidates.h"
#include "dem/contact/resistance.h"
#include "dem/contact/restitution.h"
#include "dem/contact/round_forces.h"
#include "dem/grain/parts.h"
#include "dem/motion/adaptive_damping.h"
#include "dem/motion/energy.h"
#include "dem/motion/time_step.h"
#include "dem/surface/rigid.h"

namespace trackbed::dem {

struct Scene {
  ShapeTable shapes;
  Bodies bodies;
  PairMaterials materials{1};
  Pairs pairs;
  Candidates candidates;
  PairForces forces;
  RoundForces round;
  ResistanceSettings resistance;
  bool adaptive = false;  ///< Shao's damping
  AdaptiveDamping adaptive_damping;
  StepContext context;
  Energies start;
  EnergyFlow flow;
  double time = 0;
  std::function<void(Scene&)> drive;  ///< outer loads of the new time

  /// All bodies of one material.
  Scene(double modulus, double friction, const std::string& law = "stored_energy") {
    PairMaterial m;
    m.modulus = modulus, m.friction = friction, m.tangential_ratio = 0.25;
    materials.set(0, 0, m);
    forces = make_pair_forces(law, friction > 0);
    round = make_round_forces("hertz_mindlin", friction > 0);
  }

  void evaluate_pairs(double dt) {
    StepContext c = context;
    c.dt = dt;
    forces.evaluate(bodies, shapes, materials, c, candidates.travel(), pairs);
    round.evaluate(bodies, shapes, materials, c, candidates.travel(), pairs);
    if (resistance.any()) add_resistance(resistance, bodies, materials, c, pairs);
  }
  void evaluate(double dt) {
    evaluate_pairs(dt);
    sum_forces(pairs, context, bodies);
  }
  void prepare() {
    candidates.rebuild(bodies, shapes, context, pairs);
    evaluate(0);
    flow = {};
    start = energies(bodies, pairs, context.gravity);
  }
  void step() {
    StepWork work = drift(bodies, context);
    time += context.dt;
    if (drive) drive(*this);
    candidates.update(bodies, shapes, context, pairs);
    evaluate(context.dt);
    work += kick(bodies, context);
    if (adaptive) flow.local_damping += damp(adaptive_damping, bodies, context);
    flow.applied += work.applied, flow.prescribed += work.prescribed;
    flow.local_damping += work.local_damping;
    if (forces.friction) flow.friction += friction_loss(pairs, context.threads);
    flow.contact_damping += viscous_loss(pairs, context.threads);
  }
  void run(double until) {
    const long steps = std::lround((until - time) / context.dt);
    for (long k = 0; k < steps; ++k) step();
  }
  Energies now() const { return energies(bodies, pairs, context.gravity); }
  /// Energy that came from nowhere [J].
  double closure() const { return now().total() - start.total() - flow.total(); }

  /// Edges a cube or box of density rho at x, turned by q (of the box's own axes).
  int add_block(const Vec3& edges, double rho, const Vec3& x, const Quat& q = Quat::Identity(),
                std::uint8_t freedom = kFree) {
    const GrainShape s = make_grain_shape(make_box(edges));
    const int shape = shapes.add(s);
    return add_grain(bodies, shapes, shape, 0, rho, x + q * s.origin, q * s.turn, freedom);
  }
  /// A grain of any shape, in that shape's principal frame.
  int add(const GrainShape& s, double rho, const Vec3& x, const Quat& q = Quat::Identity(),
          std::uint8_t freedom = kFree) {
    return add_grain(bodies, shapes, shapes.add(s), 0, rho, x, q, freedom);
  }
  int add_floor(double half_width, double depth, const Quat& q = Quat::Identity()) {
    return add_rigid_body(bodies, shapes, make_box({2 * half_width, 2 * half_width, depth}), 0, 1,
                          q * Vec3(0, 0, -depth / 2), q, kFixed);
  }
};

inline Quat turn_about(const Vec3& axis, double angle) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

}  // namespace trackbed::dem
