// A library of sized grain shapes, which a gradation draw scales into its sieve classes.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dem/grading/sieve_size.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct LibraryParameters {
  std::string generator = "voronoi";  ///< one of generator_names()
  int count = 1000;                   ///< shapes [-]
  std::uint64_t seed = 1;
  double spacing = 0.6;      ///< voronoi: see VoronoiParameters [-]
  double least_face = 0.05;  ///< voronoi: see VoronoiParameters [-]
  /// Mean ratios of a grain's extents L >= I >= S along its principal axes: elongation I/L and
  /// flatness S/I [-], in (0, 1]. The shapes are stretched along these axes, all by the same
  /// factors, so they keep their scatter. 0: as generated.
  double elongation = 0, flatness = 0;
  SieveMethod method = SieveMethod::exact;  ///< the size that becomes 1 m
};

/// "voronoi", "ellipsoid".
const std::vector<std::string>& generator_names();

/// Shapes of sieve size 1 m, the same for any number of threads. `progress` is told the share that
/// is done (0 … 1), by one thread at a time. Throws InputError: unknown generator (with the nearest
/// name), count < 1, ratio out of range.
std::vector<GrainShape> make_library(const LibraryParameters&,
                                     const std::function<void(double share)>& progress = {});

/// Solids of any origin (files) as shapes in their own size, sized in parallel.
std::vector<GrainShape> size_grains(const std::vector<Polyhedron>&, SieveMethod,
                                    const std::function<void(double share)>& progress = {});

}  // namespace trackbed::dem
