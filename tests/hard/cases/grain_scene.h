// A grain of any shape under any law: polyhedra under the pair laws, spheres, clumps and dilated
// polyhedra under the round ones.
#pragma once
#include "hard_case.h"
#include "motion_scene.h"

namespace trackbed::hard {

inline bool is_round(const Setting& s) {
  return s.shape == "sphere" || s.shape == "clump" || s.shape == "dilated";
}

/// Of about the diameter or edge `size` [m]. Clump: four spheres on the corners of a tetrahedron.
/// Dilated: a cube of half the size with balls of a quarter, its faces with this crown.
inline dem::GrainShape grain(const std::string& shape, double size, double crown = .02) {
  using dem::Vec3;
  if (shape == "sphere") return dem::sphere_shape(size / 2);
  if (shape == "clump") {
    const double a = .2 * size, r = .3 * size;
    return dem::as_grain(dem::make_clump_shape(
        {{{a, a, a}, r}, {{a, -a, -a}, r}, {{-a, a, -a}, r}, {{-a, -a, a}, r}}));
  }
  if (shape == "dilated")
    return dem::as_grain(dem::make_dilated_shape({solid("cube", size / 2), size / 4}), crown);
  return dem::make_grain_shape(solid(shape, size));
}

/// An empty scene under the setting's law, elastic. The linear law's stiffness: modulus x size.
inline dem::Scene scene_of(const Setting& set, double modulus, double mu, double size) {
  if (!is_round(set)) return dem::Scene(modulus, mu, set.law);
  dem::Scene s(modulus, mu);
  s.round = dem::make_round_forces(set.law, mu > 0);
  dem::PairMaterial m = s.materials(0, 0);
  m.stiffness = modulus * size;
  s.materials.set(0, 0, m);
  return s;
}

/// A sticking pair, its friction loaded by a small slide, turned as one rigid body by 360 degrees
/// about a slanted axis: by how much of its sideways force it has changed.
inline double change_of_a_turned_pair(dem::Scene& s, double slide) {
  using dem::Quat, dem::Vec3;
  dem::Bodies& b = s.bodies;
  s.context.dt = 1;
  const auto step = [&] {
    s.candidates.update(b, s.shapes, s.context, s.pairs);
    s.evaluate(1);
  };
  b.x[0].x() += slide, b.v[0] = {slide, 0, 0};
  step();
  const Vec3 before = b.force[0];
  const int steps = 4000;
  const Vec3 turn = 2 * M_PI / steps * Vec3(1, 2, 3).normalized();
  const Quat q(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
  for (int k = 0; k < steps; ++k) {
    for (int i = 0; i < 2; ++i) {
      const Vec3 old = b.x[i];
      b.x[i] = q * old;
      b.q[i] = (q * b.q[i]).normalized();
      b.R[i] = b.q[i].toRotationMatrix();
      b.v[i] = b.x[i] - old;
      b.turn[i] = b.omega[i] = turn;  // dt = 1
    }
    step();
  }
  return (b.force[0] - before).norm() / before.head<2>().norm();
}

}  // namespace trackbed::hard
