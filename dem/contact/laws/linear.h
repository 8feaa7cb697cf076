// Linear spring and dashpot (Cundall and Strack, Geotechnique 29 (1979) 47):
//
//   F_el = k delta,   U = k delta^2/2,   c = alpha sqrt(m k),   k_t = kappa k
//
// k = PairMaterial::stiffness [N/m], the same for every pair of the materials; kappa its
// round_ratio; alpha its damping, from restitution.h so that e is exact with a force that
// never pulls.
#pragma once
#include <cmath>

#include "dem/contact/laws/ball_law.h"

namespace trackbed::dem {

struct LinearLaw {
  static constexpr const char* name = "linear";
  static constexpr bool flats = false;
  template <class Number>
  BallResponseOf<Number> operator()(const BallContactOf<Number>& b,
                                    const BallMaterialOf<Number>& m) const {
    using std::sqrt;
    BallResponseOf<Number> r;
    r.elastic = m.stiffness * b.overlap;
    r.energy = 0.5 * r.elastic * b.overlap;
    r.stiffness = m.stiffness;
    r.tangential = m.round_ratio * m.stiffness;
    r.force = damped<Number>(r.elastic, m.damping * sqrt(m.stiffness * b.mass), b);
    return r;
  }
};

}  // namespace trackbed::dem
