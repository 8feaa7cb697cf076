// Polygons as they stand in an OFF, OBJ or STL file, before any check of the surface.
#pragma once
#include <string>
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

struct RawMesh {
  std::vector<Vec3> vertices;
  std::vector<std::vector<int>> faces;
  bool single_precision = false;  ///< STL
};

/// Each throws InputError "path: line n: problem" on malformed text, non-finite coordinates and
/// indices out of range.
RawMesh parse_off(const std::string& path, const std::string& text);
RawMesh parse_obj(const std::string& path, const std::string& text);
RawMesh parse_stl(const std::string& path, const std::string& text);

}  // namespace trackbed::dem
