// Lets loosely placed grains down, one after the other from the lowest, until they almost touch
// what is below: the fall that a gravity deposit need not compute.
#pragma once
#include "dem/contact/overlap.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// How far body a may go down before it meets b, at most `limit` [m]: by steps that a separating
/// axis proves free, to 1e-9 of a's radius. 0 when they overlap.
double free_fall(const ConvexView& a, const Pose&, const ConvexView& b, const Pose&, double limit);

/// Lowers the grains [first, grains) without turning them, each to `clearance` [m] above the first
/// grain or the floor that stops it. Exact: each is moved by steps that the separating axis to its
/// neighbours proves free (conservative advancement), so nothing overlaps afterwards that did not
/// before. `period` as in StepContext.
void lower_grains(Bodies&, const ShapeTable&, int first, double floor, const Vec3& period,
                  double clearance);

}  // namespace trackbed::dem
