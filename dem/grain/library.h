// A library of sized grain shapes, which a gradation draw scales into its sieve classes.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dem/grading/sieve_size.h"
#include "dem/grain/clump.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct LibraryParameters {
  std::string generator = "voronoi";  ///< one of generator_names()
  int count = 1000;                   ///< shapes [-]
  std::uint64_t seed = 1;
  double spacing = 0.6;      ///< voronoi: see VoronoiParameters [-]
  double least_face = 0.05;  ///< voronoi: see VoronoiParameters [-]
  /// ellipsoid: see EllipsoidParameters.
  Vec3 axes = Vec3(1, 0.8, 0.6);
  int points_least = 12, points_most = 24;
  /// jin_hull: see JinStonesParameters.
  double length_over_height = 1.6, length_over_height_deviation = 0.2;  ///< [-]
  int divisions = 2;                                                    ///< N_d [-]
  double least_scale = 0.8, largest_scale = 1.2;                        ///< S_l, S_u [-]
  /// files: OFF, OBJ or STL files of stones (scanned ones, say), one or more in each; they make the
  /// library, `count` and `seed` do not matter. Their size does not either. `hull`: see
  /// SolidOptions.
  std::vector<std::string> files;
  bool hull = false;
  /// Targets for the library's means, see ShapeTargets; 0: as generated.
  double elongation = 0, flatness = 0, sphericity = 0, angularity = 0;
  /// So many of the shapes are stretched until they are needles, so many others pressed until they
  /// are flaky (see LibraryIndices): what a draw with given shares takes them from.
  int needles = 0, flakes = 0;
  SieveMethod method = SieveMethod::exact;  ///< the size that becomes 1 m
};

/// "voronoi", "ellipsoid", "jin_hull" (the convex hulls of Jin's stones), "files".
const std::vector<std::string>& generator_names();

/// Shapes of sieve size 1 m, the same for any number of threads. `progress` is told the share that
/// is done (0 … 1), by one thread at a time. Throws InputError: unknown generator (with the nearest
/// name), count < 1, targets out of range or out of reach, more needles and flakes than shapes;
/// as read_solids.
std::vector<GrainShape> make_library(const LibraryParameters&,
                                     const std::function<void(double share)>& progress = {});

/// Solids of any origin (files) as shapes in their own size, sized in parallel.
std::vector<GrainShape> size_grains(const std::vector<Polyhedron>&, SieveMethod,
                                    const std::function<void(double share)>& progress = {});

/// Jin's stones (count, seed and the jin parameters) filled with spheres, sieve size 1 m each.
/// `least_radius` is a share of the stone's W (0.12 for the paper's 47 spheres: 7 mm of 58 mm).
/// Throws as make_library and fill_with_spheres.
std::vector<ClumpShape> make_clump_library(const LibraryParameters&, double least_radius = 0.12,
                                           double space_factor = 1.3,
                                           const std::function<void(double share)>& progress = {});

}  // namespace trackbed::dem
