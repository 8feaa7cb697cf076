// Closed solids from files: OFF, Wavefront OBJ, STL (ASCII and binary).
#pragma once
#include <string>
#include <vector>

#include "dem/grain/mesh_parse.h"
#include "dem/grain/polyhedron.h"
#include "dem/grain/triangle_solid.h"

namespace trackbed::dem {

struct SolidOptions {
  double unit = 1;    ///< length of the file's unit [m]; 0.001 for millimetres
  bool hull = false;  ///< true: a solid that is not convex is replaced by its convex hull
};

/// The solid in a file, by its extension (.off, .obj, .stl), as a convex polyhedron in metres with
/// coplanar facets merged (within 1e-9 of its size; 3e-7 for STL, whose numbers are single
/// precision). Throws InputError in one line naming file and problem: unreadable or of unknown
/// kind, malformed line, NaN, index out of range, open or non-manifold surface, faces wound against
/// each other, inside-out, no volume, self-intersecting, several solids, not convex (unless
/// `hull`).
Polyhedron read_solid(const std::string& path, const SolidOptions& = {});

/// All solids of a file, in the order of their first faces; what no face joins is a solid of its
/// own. Throws as read_solid, "path: solid n: problem" where there are several.
std::vector<Polyhedron> read_solids(const std::string& path, const SolidOptions& = {});

/// The same of polygons that were read already; `name` heads the messages.
Polyhedron check_solid(const std::string& name, const RawMesh&, const SolidOptions& = {});

/// The solid in a file as it is, convex or not, its faces cut into triangles from their first
/// corner (faces must be convex). Throws as read_solid.
TriangleSolid read_triangle_solid(const std::string& path, double unit = 1);

/// OFF with all digits.
std::string off_text(const Polyhedron&);

/// Writes it. Throws InputError when the file cannot be written.
void write_off(const std::string& path, const Polyhedron&);
void write_off(const std::string& path, const TriangleSolid&);

}  // namespace trackbed::dem
