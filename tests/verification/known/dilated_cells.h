// A dilated cube by counting small cells, as Sun, Yan, Zhao, Ji 2015 do: what Steiner's formula is
// compared with.
#pragma once
#include "tests/unit/grain_solids.h"

namespace trackbed::dem::known {

struct CellSum {
  double volume = 0, inertia = 0;  ///< of density 1 about the centre; the body is isotropic
};

/// The unit cube, turned anyhow, dilated by r: `cells` along each edge of its bounding cube; those
/// whose middle lies in the body count whole.
inline CellSum dilated_cube_by_cells(double r, int cells) {
  const Mat3 turn = solids::any_turn.toRotationMatrix();
  const double half = std::sqrt(.75) + r, h = 2 * half / cells;
  CellSum sum;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const Vec3 x = Vec3(i + .5, j + .5, k + .5) * h - Vec3::Constant(half);
        const Vec3 out = ((turn * x).cwiseAbs() - Vec3::Constant(.5)).cwiseMax(0);
        if (out.squaredNorm() > r * r) continue;
        sum.volume += h * h * h;
        sum.inertia += h * h * h * 2 / 3 * x.squaredNorm();
      }
  return sum;
}

}  // namespace trackbed::dem::known
