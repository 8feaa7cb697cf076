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

}  // namespace trackbed::hard
