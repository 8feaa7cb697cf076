// The law of Sun, Yan, Zhao, Ji 2015, (5)-(11), whose formulas are lost in print and rebuilt here
// from the constants in the text:
//
//   F_el = K_n delta^(3/2),  K_n = 4 G sqrt(R*)/(3 (1-nu)),   U = 2/5 F_el delta
//   k_t  = kappa K_n delta^(1/2),  kappa = 3 (1-nu)/(2-nu) of the secant stiffness
//   c    = alpha sqrt(m K_n) delta^(1/4)
//
// K_n is Hertz's constant for equal materials, G/(1-nu) = E*, so modulus = E* here as well, and
// kappa = 3/2 round_ratio: on spheres the law is Mindlin's. What differs is the damping: alpha
// of a force that may pull (Tsuji's formula, tsuji_damping), as in the paper's time; the pulling
// part is cut off, so that a stated e comes out larger (0.2 gives 0.325, 0.6 gives 0.632).
#pragma once
#include "dem/contact/laws/hertz_mindlin.h"

namespace trackbed::dem {

struct Sun2015Law {
  static constexpr const char* name = "sun2015";
  static constexpr bool flats = false;
  template <class Number>
  BallResponseOf<Number> operator()(const BallContactOf<Number>& b,
                                    const BallMaterialOf<Number>& m) const {
    using std::sqrt;
    BallResponseOf<Number> r;
    const Number secant = 4. / 3 * m.modulus * sqrt(b.radius * b.overlap);  // K_n delta^(1/2)
    r.elastic = secant * b.overlap;
    r.energy = 0.4 * r.elastic * b.overlap;
    r.stiffness = 1.5 * secant;
    r.tangential = 1.5 * m.round_ratio * secant;
    r.force = damped<Number>(r.elastic, m.damping * sqrt(secant * b.mass), b);
    return r;
  }
};

}  // namespace trackbed::dem
