// One tetrahedron of a surface's shell as the overlap kernel reads it.
#pragma once
#include <array>
#include <cstdint>

#include "dem/contact/shape_table.h"
#include "dem/surface/patch.h"

namespace trackbed::dem {

/// Vertices and planes relative to `origin`, world axes. Not copyable: the view points into it.
struct ShellCell {
  double x[8], y[8], z[8];
  double nx[4], ny[4], nz[4], offset[4];
  Vec3 origin;
  ConvexView view;
  int outer_face = -1;  ///< the face that lies on the surface, -1 if none
  int inner_face = -1;  ///< the face that lies on the bottom of the shell, -1 if none

  ShellCell() = default;
  ShellCell(const ShellCell&) = delete;
  ShellCell& operator=(const ShellCell&) = delete;
};

/// Corner positions [m] of cell 3 triangle + k (see patch_forces.h).
std::array<Vec3, 4> cell_corners(const SurfacePatch&, int cell);

/// Fills `out` for the cell moved by `shift`.
void make_shell_cell(const SurfacePatch&, int cell, const Vec3& shift, ShellCell& out);

/// Outward unit normal of a triangle.
Vec3 triangle_normal(const SurfacePatch&, int triangle);

}  // namespace trackbed::dem
