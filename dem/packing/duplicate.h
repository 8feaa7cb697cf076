// A packed sample repeated: a tall or long bed for the price of a small one (Jin, Zeng, Ye, Li
// 2017 pile three thirds of their specimen).
#pragma once
#include <cstdint>

#include "dem/packing/packed_grains.h"

namespace trackbed::dem {

struct LayerSettings {
  int layers = 2;              ///< the sample included
  Vec3 low, high;              ///< of the box in x and y; low.z is the floor [m]
  Vec3 period = Vec3::Zero();  ///< box length in a periodic direction [m], else 0
  /// Spacing of the layers [m]. 0: each is let down as one block until a grain of it is `clearance`
  /// above one below, an exact distance; the seam then still has to settle.
  double spacing = 0;
  double clearance = 1e-4;  ///< [m]
  /// Further down [m]: the flat lower side of a copy then sinks into the rough top below, and the
  /// grains of the copy that would overlap others are left out.
  double sink = 0;
  /// No layer lies like the one below it: turned by half about the vertical, mirrored in x, in y
  /// (in a square box without a seam also turned by a quarter) in turn, and shifted along a
  /// periodic direction by a random way. Off: plain copies, as in the paper.
  bool varied = true;
  std::uint64_t seed = 1;
};

struct LayeredBed {
  PackedGrains bed;                  ///< sample and copies, layer by layer, in the sample's order
  std::vector<int> layer;            ///< of each grain, 0 = the sample
  std::vector<GrainShape> left_out;  ///< of the copies, where they would have overlapped
};

/// Nothing overlaps that did not in the sample. Throws InputError: fewer than one layer, no grains,
/// a negative spacing or sink.
LayeredBed duplicate_layers(const PackedGrains& sample, const LayerSettings&);

/// A sample that is periodic along `axis` (0 = x, 1 = y), `copies` times in a row, the first in its
/// place. Contacts across the seams are those of the sample's own seam: nothing has to settle.
/// The bed stays periodic with the finer period until its grains are moved.
PackedGrains duplicate_along(const PackedGrains& sample, int axis, double period, int copies);

/// The grain's mirror image in the plane x[axis] = at.
void mirror(PackedGrains&, int grain, int axis, double at);

}  // namespace trackbed::dem
