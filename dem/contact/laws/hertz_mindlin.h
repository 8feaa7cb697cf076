// Hertz and Mindlin with Tsuji's damping:
//
//   F_el = 4/3 E* sqrt(R*) delta^(3/2),   U = 2/5 F_el delta
//   c    = alpha sqrt(m k) delta^(1/4),   k = 4/3 E* sqrt(R*)                           [N s/m]
//   k_t  = kappa 2 E* sqrt(R* delta),     kappa = 4 G*/E*                                [N/m]
//
// E* = PairMaterial::modulus, 1/E* = (1-nu_a^2)/E_a + (1-nu_b^2)/E_b; kappa its round_ratio,
// equal materials: 2 (1-nu)/(2-nu); alpha its damping. With this c restitution does not depend on
// speed, size or stiffness (Tsuji, Tanaka, Ishida, Powder Technol. 71 (1992) 239). Their alpha(e)
// holds for a force that may pull at the end; for this one, which never does, restitution.h finds
// alpha so that e is exact.
#pragma once
#include <cmath>

#include "dem/contact/laws/ball_law.h"

namespace trackbed::dem {

struct HertzMindlinLaw {
  static constexpr const char* name = "hertz_mindlin";
  static constexpr bool flats = false;  ///< flat faces answer by their area
  template <class Number>
  BallResponseOf<Number> operator()(const BallContactOf<Number>& b,
                                    const BallMaterialOf<Number>& m) const {
    using std::sqrt;
    BallResponseOf<Number> r;
    const Number s = m.modulus * sqrt(b.radius * b.overlap);  // E* a, a the contact's radius
    r.elastic = 4. / 3 * s * b.overlap;
    r.energy = 0.4 * r.elastic * b.overlap;
    r.stiffness = 2 * s;
    r.tangential = m.round_ratio * r.stiffness;
    r.force = damped<Number>(r.elastic, m.damping * sqrt(4. / 3 * s * b.mass), b);
    return r;
  }
};

}  // namespace trackbed::dem
