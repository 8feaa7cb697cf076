// Generators of ballast-like convex grains: Voronoi cells (as Eliáš 2014, Powder Technology
// 264:458) and hulls of random points on an ellipsoid. The same seed gives the same grains.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct VoronoiParameters {
  int count = 1000;  ///< cells = grains [-]
  std::uint64_t seed = 1;
  /// Least distance of two seed points as a share of the edge of the mean cell's cube [-], in
  /// [0, 0.8]. 0: a Poisson process, very uneven cells; 0.7: near the densest random set.
  double spacing = 0.6;
  /// Faces smaller than this share of a cell's mean face are left out and their neighbours
  /// extended until they meet, so slivers vanish and the cell stays convex [-]; 0 keeps all.
  double least_face = 0.05;
};

/// The Voronoi cells of random points with a least spacing in a periodic cube whose mean cell
/// volume is 1 m3, each about its own seed point. Point p's cell is {x: n.x <= n.n/2} for all
/// vectors n from p to the others; its corners are the facets of the hull of the dual points
/// 2n/(n.n). Throws InputError when count < 1 or spacing or least_face is out of range.
std::vector<Polyhedron> voronoi_grains(const VoronoiParameters&);

/// The body {x: n_i.x <= offset_i} (offsets positive: the origin is inside), by the hull of the
/// dual points n_i / offset_i. Throws InputError when it is unbounded or an offset not positive.
Polyhedron intersect_half_spaces(const std::vector<Vec3>& normals,
                                 const std::vector<double>& offsets);

struct EllipsoidParameters {
  int count = 1000;
  std::uint64_t seed = 1;
  int points_least = 12, points_most = 24;  ///< vertices of a grain, uniform in between [-]
  Vec3 axes = Vec3(1, 0.8, 0.6);            ///< full axes of the ellipsoid [m]
};

/// Hulls of random points on an ellipsoid, spread by a least distance that is relaxed until they
/// fit. Throws InputError when count < 1, points_least < 4, points_most < points_least, an axis <=
/// 0.
std::vector<Polyhedron> ellipsoid_grains(const EllipsoidParameters&);

}  // namespace trackbed::dem
