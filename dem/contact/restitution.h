// The damping that gives a wanted restitution in a head-on collision, for forces that never pull.
#pragma once
#include <string>

namespace trackbed::dem {

/// Restitution of x'' = -max(0, x^p + alpha x^q x'), from x = 0, x' = 1 until the force ends: the
/// ball laws made dimensionless. Hertz-Mindlin: p = 3/2, q = 1/4; linear: p = 1, q = 0.
double restitution(bool hertz, double alpha);

/// alpha of a law (by name) for a coefficient of restitution: hertz_mindlin, hertz_flat and linear
/// by inverting restitution(), sun2015 by tsuji_damping. 1 gives 0. Throws InputError unless 0.01
/// <= e <= 1, and for a law that is not among these.
double damping_for_restitution(const std::string& law, double e);

/// Its inverse: the coefficient of restitution that a law's alpha gives.
double restitution_for_damping(const std::string& law, double alpha);

/// -sqrt(5) ln e/sqrt(ln^2 e + pi^2): Hertz with a force that may pull.
double tsuji_damping(double e);

}  // namespace trackbed::dem
