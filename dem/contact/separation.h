// Separating axes of convex polyhedra, as used before the overlap is clipped.
//
// Cheap use, per pair and step: a pair that touched in the last step goes straight to overlap()
// with its last normal; only when that finds nothing, or for a pair that was apart, separating_axis
// is called. A cached axis that still separates costs one projection of each body.
//
// Method: support gap along an axis n, g(n) = min_b n.p - max_a n.p. Any g > 0 proves separation.
// When the cached axis fails, Gilbert, Johnson & Keerthi's distance iteration (IEEE J. Robotics
// Autom. 4, 1988) proposes new axes; each is accepted only by its own support gap, so that rounding
// in the iteration can never make a false "separated". Deterministic.
#pragma once
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// min over b of n.p less max over a of n.p [m], n a unit vector in world axes.
double support_gap(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&,
                   const Vec3& n);

}  // namespace trackbed::dem
