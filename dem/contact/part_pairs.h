// From pairs of bodies to pairs of their convex parts: a clump's spheres, a non-convex body's
// polyhedra. Bodies of one part each are their own pair.
#pragma once
#include <utility>
#include <vector>

#include "dem/contact/pairs.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// Kind of a pair of parts; `swapped`: the second one has the role of a.
PairKind pair_kind(const PartView&, const PartView&, bool& swapped);

/// Enlarges the box [low, high] (relative to the body's centre, world axes [m]) by a part.
void include_part(const PartView&, const Mat3& R, Vec3& low, Vec3& high);

/// Appends to `keys`, sorted, the parts of each pair of bodies that are nearer than `skin` [m] by
/// their boxes (spheres: by their distance).
void find_part_pairs(const Bodies&, const ShapeTable&,
                     const std::vector<std::pair<int, int>>& found, const Vec3& period, double skin,
                     std::vector<PairKey>& keys);

}  // namespace trackbed::dem
