// What a contact of dilated polyhedra with a flat part (flat_contact.h, surface/flat_patch.h)
// answers with: the forces of the deepest balls by the law of round contacts, of the flats by
// theirs, each where it acts; so the normal force is the gradient of the sum of both energies.
// Friction and damping act on that sum, at one point between the two.
#pragma once
#include "dem/contact/flat_contact.h"
#include "dem/contact/pair_evaluate.h"
#include "dem/contact/round_response.h"

namespace trackbed::dem {

/// Elastic forces on a of the deepest balls and the flat parts, and their sum.
struct BallsAndFlats {
  BallResponseOf<double> ball;
  Vec3 of_balls, elastic;  ///< [N]
  Vec3 direction;          ///< of minus the sum, unit
  double size;             ///< of the sum [N]
  double share;            ///< of the flats in the point where friction acts, 0 to 1
};

/// `contact` and n as of the deepest balls alone; its rate is not read.
template <class Law>
BallsAndFlats balls_and_flats(const PairMaterial& material, const BallContactOf<double>& contact,
                              const Vec3& n, const Vec3& flat_force) {
  BallsAndFlats s;
  s.ball = Law()(contact, ball_material(material));
  s.of_balls = -s.ball.elastic * n;
  s.elastic = s.of_balls + flat_force;
  s.size = s.elastic.norm();
  s.direction = -s.elastic / s.size;
  const double flat_size = flat_force.norm();
  s.share = flat_size / (flat_size + s.ball.elastic);
  return s;
}

/// Damping and friction of the sum over the step, for contact i of Pairs or PatchContacts: advances
/// its history, writes its losses, energies, area, depth, stiffness. `area` is the size of the
/// flats' vector area, `crowns` the sum of both bodies' crowns. Returns the normal force with
/// damping [N]. Damping: c = alpha sqrt(m F/delta) of the sum's elastic force F, as in the law of
/// the balls. Tilting moves the deepest balls over the crowned faces as well, by 1/crowns a radian.
template <bool friction, class Contacts>
double advance_balls_and_flats(const PairMaterial& material, const BallContactOf<double>& contact,
                               const BallsAndFlats& sum, const OverlapShape& shape,
                               const NormalResponse& flat, double area, double crowns,
                               const ContactSlip& slip, Contacts& k, int i) {
  const double way = sum.direction.dot(slip.displacement);
  BallContactOf<double> moving = contact;
  moving.rate = contact.dt > 0 ? way / contact.dt : 0;
  const double c = material.damping * std::sqrt(sum.size / contact.overlap * contact.mass);
  const double force = damped<double>(sum.size, c, moving), viscous = force - sum.size;
  k.viscous_loss[i] = (k.viscous[i] + viscous) / 2 * way;
  k.viscous[i] = viscous;
  k.friction_energy[i] = k.friction_loss[i] = 0;
  if constexpr (friction) {
    const double tangential = sum.ball.tangential + material.round_ratio * kShaoFactor *
                                                        material.modulus * std::sqrt(area);
    const FrictionResult result =
        advance_friction<Vec3>(material.friction, tangential, sum.direction, force, slip,
                               k.friction[i], k.friction_stiffness[i]);
    k.friction_energy[i] = result.stored;
    k.friction_loss[i] = result.dissipated;
  }
  k.touching[i] = 1;
  k.energy[i] = sum.ball.energy + flat.energy;
  k.area[i] = M_PI * contact.radius * contact.overlap + area;
  k.depth[i] = contact.overlap;
  k.stiffness[i] = sum.ball.stiffness + flat.stiffness;
  k.tilt_stiffness[i] = tilt_stiffness(shape, flat.stiffness) + sum.ball.elastic / crowns;
  return force;
}

/// Writes forces, energies and history of pair p. `at` the point of the balls from a's centre,
/// `apart` b's centre from a's.
template <class Law, bool friction>
void respond_flat(const Bodies& b, const PairMaterial& material,
                  const BallContactOf<double>& contact, const Vec3& n, const Vec3& at,
                  const NormalContact& flat, double crowns, const Vec3& apart, Pairs& pairs,
                  int p) {
  const int i = pairs.a[p], j = pairs.b[p];
  const BallsAndFlats sum = balls_and_flats<Law>(material, contact, n, flat.force);
  const Vec3 arm_a = at + sum.share * (flat.centroid - at), arm_b = arm_a - apart;
  ContactSlip slip{Vec3::Zero(), Vec3::Zero()};
  if (contact.dt > 0) {
    const bool old = pairs.touching[p];
    slip = contact_slip<Vec3>(contact.dt, b.v[i], b.turn[i], old ? pairs.arm_a[p] : arm_a, arm_a,
                              b.v[j], b.turn[j], old ? pairs.arm_b[p] : arm_b, arm_b);
  }
  const double force =
      advance_balls_and_flats<friction>(material, contact, sum, flat.shape, flat.response,
                                        flat.shape.area.norm(), crowns, slip, pairs, p);
  pairs.normal_force[p] = force;
  pairs.force[p] = -force * sum.direction;
  if constexpr (friction) pairs.force[p] += pairs.friction[p];
  pairs.couple[p] =
      flat.couple + (flat.centroid - arm_a).cross(flat.force) + (at - arm_a).cross(sum.of_balls);
  pairs.axis[p] = sum.direction;
  pairs.arm_a[p] = arm_a;
  pairs.arm_b[p] = arm_b;
}

}  // namespace trackbed::dem
