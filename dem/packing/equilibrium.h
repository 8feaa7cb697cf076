// When a bed has come to rest.
#pragma once
#include "dem/contact/pairs.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// Mean resultant of contacts, outer load and weight on a grain over the mean contact force: 0 in
/// equilibrium, about 1 while grains fly. Infinite while nothing touches.
double unbalanced_share(const Bodies&, const Pairs&, const Vec3& gravity);

}  // namespace trackbed::dem
