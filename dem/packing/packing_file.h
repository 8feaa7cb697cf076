// A packing as files that other programs read, and back from them.
//
//   OFF  all grains in one file, in the scene's coordinates [m]
//   CSV  one line a grain: place, quaternion, shape, kind; shape k is a file in <stem>_shapes in
//        its principal frame: <k>.off, a polyhedron, the core that is dilated by radius_m, or the
//        convex solids, closed each, of a grain of several pieces; <k>.csv, spheres, x,y,z,r a line
//   VTU  one polyhedral cell a grain, with its number, sieve size and volume (ParaView); of a clump
//        one a sphere, with its grain's
//
// OFF and VTU hold outlines (grain_pieces.h): what is read back from OFF are polyhedra, of the same
// volume where grains were spheres or dilated. OFF holds no clumps.
//
// All digits are written: what is read back differs by rounding of the arithmetic alone.
#pragma once
#include <string>

#include "dem/packing/packed_grains.h"

namespace trackbed::dem {

/// Throws InputError for a grain of several parts.
std::string packing_off_text(const PackedGrains&);
std::string packing_vtu_text(const PackedGrains&);

/// A shape's own file: how its name ends, and what it holds. Throws InputError for a union of
/// dilated polyhedra.
struct ShapeFile {
  std::string ending, text;
};
ShapeFile shape_file(const GrainShape&);

/// `shape_of[i]` names the shape file of grain i (distinct_shapes).
std::string packing_csv_text(const PackedGrains&, const std::vector<int>& shape_of);

/// Number of each grain's shape among those that differ, in order of appearance; the first grain of
/// shape k is first_of[k].
struct DistinctShapes {
  std::vector<int> shape_of, first_of;
};
DistinctShapes distinct_shapes(const PackedGrains&);

/// From an OFF file with one or many solids, or a CSV file with its shapes, by the file's ending.
/// Sieve sizes are those of the CSV; 0 after OFF. Without the column `kind` all are polyhedra.
/// Throws InputError in one line naming file, and line or solid: what read_solid refuses, columns
/// missing, numbers malformed, no grains.
PackedGrains read_packing(const std::string& path);

/// Every file that read_packing(path) reads, path first.
std::vector<std::string> packing_files(const std::string& path);

}  // namespace trackbed::dem
