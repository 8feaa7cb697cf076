// Needles and flakes among grains.
#pragma once
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// By BS 812 and TB/T 2140 with the grain's own sieve size: flaky, least width < 0.6 of it; needle,
/// largest diameter > 1.8 of it.
enum class GrainForm { ordinary, needle, flaky, needle_and_flaky };

/// Of what is not a polyhedron, width and diameter are those of the polyhedron around it
/// (GrainShape::body), a little too large.
/// Throws InputError when a shape is not sized. In parallel.
std::vector<GrainForm> grain_forms(const std::vector<GrainShape>&);

}  // namespace trackbed::dem
