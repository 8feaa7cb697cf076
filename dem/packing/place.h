// Loose placement without overlap: each grain's bounding sphere is let down onto those already
// placed, at the lowest of a few random spots. The start of a gravity deposit.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

/// Where grains may be put: a box, optionally with blocks inside that must stay free (a sleeper).
struct PlacementSpace {
  Vec3 low, high;              ///< floor at low.z; high.z is not a limit
  Vec3 period = Vec3::Zero();  ///< in a periodic direction the box length, else 0 [m]
  struct Block {
    Vec3 low, high;
  };
  std::vector<Block> blocks;  ///< kept free, from their bottom to any height
  /// Nested rectangles in plan. A grain of zone k has its centre inside zones[k] and outside
  /// zones[k-1]; zone zones.size() is what is left.
  std::vector<Block> zones;
  double radius = 0;  ///< of a round container about the middle of the box [m]; 0 = the box
};

/// Spheres already there that must not be touched.
struct PlacedSpheres {
  std::vector<Vec3> centre;
  std::vector<double> radius;
};

struct Placement {
  std::vector<Vec3> centre;  ///< [m]
  std::vector<Quat> turn;    ///< random, uniform over rotations
};

/// Places spheres of the given radii [m] in the given order, `tries` spots each. Reproducible by
/// `seed` on any machine. `zone`: of each grain; empty = anywhere. Throws InputError when a grain
/// is wider than the space or its zone.
Placement place_loose(const std::vector<double>& radii, const PlacementSpace&,
                      const PlacedSpheres& present, int tries, std::uint64_t seed,
                      const std::vector<int>& zone = {});

}  // namespace trackbed::dem
