// What a change of size does to every kind of grain shape.
#pragma once
#include <cmath>
#include <string>

#include "base/error.h"

namespace trackbed::dem {

/// Scales volume, moments, bounding radius, sieve size and origin of a grain, clump or dilated
/// shape; what it is made of is the caller's. Throws InputError when the factor is not positive and
/// finite.
template <class Shape>
void scale_solid(Shape& shape, double factor, const std::string& kind) {
  if (!(factor > 0) || !std::isfinite(factor))
    throw InputError(kind + ": a scale must be positive and finite");
  shape.volume *= factor * factor * factor;
  shape.inertia *= factor * factor * factor * factor * factor;
  shape.radius *= factor;
  shape.sieve_size *= factor;
  shape.origin *= factor;
}

}  // namespace trackbed::dem
