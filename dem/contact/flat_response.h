// What a contact of dilated polyhedra with a flat part (flat_contact.h) answers with: the forces of
// the deepest balls by the law of round contacts, of the flats by theirs, each where it acts; so
// the normal force is the gradient of the sum of both energies. Friction and damping act on that
// sum, at one point between the two.
#pragma once
#include "dem/contact/flat_contact.h"
#include "dem/contact/pair_evaluate.h"
#include "dem/contact/round_response.h"

namespace trackbed::dem {

/// Writes forces, energies and history of pair p. `contact` and n as of the deepest balls alone,
/// `at` their point from a's centre, `apart` b's centre from a's. Damping: c = alpha sqrt(m
/// F/delta) of the sum's elastic force F, as in the law of the balls.
template <class Law, bool friction>
void respond_flat(const Bodies& b, const PairMaterial& material,
                  const BallContactOf<double>& contact, const Vec3& n, const Vec3& at,
                  const NormalContact& flat, const Vec3& apart, Pairs& pairs, int p) {
  const int i = pairs.a[p], j = pairs.b[p];
  const BallResponseOf<double> ball = Law()(contact, ball_material(material));
  const Vec3 of_balls = -ball.elastic * n, elastic = of_balls + flat.force;
  const double size = elastic.norm(), flat_size = flat.force.norm();
  const Vec3 direction = -elastic / size;
  const Vec3 arm_a = at + flat_size / (flat_size + ball.elastic) * (flat.centroid - at),
             arm_b = arm_a - apart;
  ContactSlip slip{Vec3::Zero(), Vec3::Zero()};
  if (contact.dt > 0) {
    const bool old = pairs.touching[p];
    slip = contact_slip<Vec3>(contact.dt, b.v[i], b.turn[i], old ? pairs.arm_a[p] : arm_a, arm_a,
                              b.v[j], b.turn[j], old ? pairs.arm_b[p] : arm_b, arm_b);
  }
  const double way = direction.dot(slip.displacement);
  BallContactOf<double> moving = contact;
  moving.rate = contact.dt > 0 ? way / contact.dt : 0;
  const double c = material.damping * std::sqrt(size / contact.overlap * contact.mass);
  const double force = damped<double>(size, c, moving), viscous = force - size;
  pairs.viscous_loss[p] = (pairs.viscous[p] + viscous) / 2 * way;
  pairs.viscous[p] = viscous;
  pairs.normal_force[p] = force;
  pairs.force[p] = -force * direction;
  pairs.friction_energy[p] = pairs.friction_loss[p] = 0;
  const double area = flat.shape.area.norm();
  if constexpr (friction) {
    const double tangential =
        ball.tangential + material.round_ratio * kShaoFactor * material.modulus * std::sqrt(area);
    const FrictionResult result =
        advance_friction<Vec3>(material.friction, tangential, direction, force, slip,
                               pairs.friction[p], pairs.friction_stiffness[p]);
    pairs.force[p] += pairs.friction[p];
    pairs.friction_energy[p] = result.stored;
    pairs.friction_loss[p] = result.dissipated;
  }
  pairs.touching[p] = 1;
  pairs.couple[p] =
      flat.couple + (flat.centroid - arm_a).cross(flat.force) + (at - arm_a).cross(of_balls);
  pairs.energy[p] = ball.energy + flat.response.energy;
  pairs.area[p] = M_PI * contact.radius * contact.overlap + area;
  pairs.depth[p] = contact.overlap;
  pairs.stiffness[p] = ball.stiffness + flat.response.stiffness;
  pairs.tilt_stiffness[p] = tilt_stiffness(flat.shape, flat.response.stiffness);
  pairs.axis[p] = direction;
  pairs.arm_a[p] = arm_a;
  pairs.arm_b[p] = arm_b;
}

}  // namespace trackbed::dem
