// A settled, periodic bed of Voronoi grains or spheres made from `dem` alone, so that a benchmark
// needs no run of the program; kept in a file between calls.
#pragma once
#include <string>

#include "motion_scene.h"

namespace trackbed::dem {

struct BedSettings {
  int grains = 1000;      ///< of 14-20 corners, sieve sizes about 25-60 mm
  double modulus = 2e9;   ///< of the grains at the end [Pa]
  double friction = 0.5;  ///< at the end; packed with 0.1
  int threads = 1;        ///< while it settles
  bool spheres = false;   ///< instead, of 18-27 mm radius; settled soft only, not kept in files
  std::string folder;     ///< where a bed is kept; empty: nowhere
};

/// Grains let down until they almost touch, on a base, soft (E 2e7 Pa, friction 0.1): a bed to be.
Scene loose_bed(int grains);

/// Loose grains let down, settled soft, then with the final constants until quiet. About a minute
/// for 1000 grains; read from the folder if it is there. `settings.modulus` is in the scene.
Scene settled_bed(const BedSettings&);

/// The same bed `copies` times in x and in y, each copy with shapes of its own: still settled.
Scene tiled(const Scene& bed, int copies_x, int copies_y);

}  // namespace trackbed::dem
