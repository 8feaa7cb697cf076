// A packing as files that other programs read, and back from them.
//
//   OFF  all grains in one file, in the scene's coordinates [m]
//   CSV  one line a grain: place, quaternion, shape; shape k is <stem>_shapes/<k>.off in its
//        principal frame
//   VTU  one polyhedral cell a grain, with its number, sieve size and volume (ParaView)
//
// All digits are written: what is read back differs by rounding of the arithmetic alone.
#pragma once
#include <string>

#include "dem/packing/packed_grains.h"

namespace trackbed::dem {

std::string packing_off_text(const PackedGrains&);
std::string packing_vtu_text(const PackedGrains&);

/// `shape_of[i]` names the shape file of grain i (distinct_shapes).
std::string packing_csv_text(const PackedGrains&, const std::vector<int>& shape_of);

/// Number of each grain's shape among those that differ, in order of appearance; the first grain of
/// shape k is first_of[k].
struct DistinctShapes {
  std::vector<int> shape_of, first_of;
};
DistinctShapes distinct_shapes(const PackedGrains&);

/// From an OFF file with one or many solids, or a CSV file with its shapes, by the file's ending.
/// Sieve sizes are those of the CSV; 0 after OFF. Throws InputError in one line naming file, and
/// line or solid: what read_solid refuses, columns missing, numbers malformed, no grains.
PackedGrains read_packing(const std::string& path);

/// Every file that read_packing(path) reads, path first.
std::vector<std::string> packing_files(const std::string& path);

}  // namespace trackbed::dem
