// Contact forces of the pairs that are not two plain polyhedra: spheres, clumps, dilated polyhedra,
// among each other and on polyhedra. One plain loop for each kind of pair (PairKind), law and
// friction fixed when the scene is built, as in pair_forces.h.
//
// Contact point: the middle of the overlap on the line of both centres. `depth` is the overlap,
// `area` that of the circle pi R* delta.
#pragma once
#include "dem/contact/pair_forces.h"

namespace trackbed::dem {

struct RoundForces {
  std::string law;
  bool friction = false;
  bool flat_faces = false;  ///< of dilated polyhedra answer by their area (flat_contact.h)
  PairForces::Evaluate evaluate = nullptr;  ///< all kinds but polyhedra
};

/// Laws: "hertz_mindlin", "hertz_flat", "sun2015", "linear". Throws InputError naming the laws
/// there are.
RoundForces make_round_forces(const std::string& law, bool friction);
std::vector<std::string> round_law_names();

}  // namespace trackbed::dem
