// Shapes brought to given mean form: stretched for elongation, flatness, sphericity; edges blunted
// for angularity; single grains made needles or flakes.
#pragma once
#include <vector>

#include "dem/grading/sieve_size.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// Means over the shapes [-], 0: not asked for.
struct ShapeTargets {
  /// I/L and S/I of the extents L >= I >= S along a grain's principal axes, in (0, 1]. Every shape
  /// is stretched along these axes by the same factors, so the scatter is kept.
  double elongation = 0, flatness = 0;
  /// Wadell's sphericity (ShapeIndices), in (0, 1): reached by stretching I and S by factors k and
  /// k^2 of L. Not together with elongation or flatness, which fix it.
  double sphericity = 0;
  /// Mean angle of the edges (ShapeIndices): reached by blunting the sharpest edges, the same share
  /// of them on every grain; at most that of the shapes as they come.
  double angularity = 0;
};

/// Throws InputError: a target out of range, or out of reach with the range that can be reached.
std::vector<Polyhedron> reach_targets(std::vector<Polyhedron>, const ShapeTargets&);

/// The grain with the sharpest `share` [-] of its edges cut off by planes of equal angle to both
/// faces, `depth` [-] of the way from the edge to the centroid.
Polyhedron blunted(const Polyhedron&, double share, double depth = 0.06);

/// Longest axis stretched until the largest diameter exceeds 1.8 sieve sizes by 5 %: elongated by
/// BS 812 and TB/T 2140. A grain that is, is returned as it is.
Polyhedron as_needle(const Polyhedron&, SieveMethod = SieveMethod::exact);
/// Shortest axis pressed until the least width is below 0.6 sieve sizes by 5 %.
Polyhedron as_flake(const Polyhedron&, SieveMethod = SieveMethod::exact);

}  // namespace trackbed::dem
