// Points sorted into a grid of cells at least `width` wide, so that all points within `width` of a
// point lie in the 27 cells around it. Periodic directions wrap around.
#pragma once
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

class CellGrid {
 public:
  /// Throws InputError when a periodic direction is less than three cells long.
  CellGrid(const Vec3* x, int points, double width, const Vec3& period);

  int cells() const { return n_[0] * n_[1] * n_[2]; }

  /// Calls f(i, j) for each point i of the cell and each point j of the cells around it and of
  /// its own; i ascending, j in a fixed order.
  template <class F>
  void for_each_near(int cell, F&& f) const {
    if (begin_[cell] == begin_[cell + 1]) return;
    const int c[3] = {cell % n_[0], cell / n_[0] % n_[1], cell / (n_[0] * n_[1])};
    for (int at = begin_[cell]; at < begin_[cell + 1]; ++at)
      for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int near = neighbour(c[0] + dx, c[1] + dy, c[2] + dz);
            if (near < 0) continue;
            for (int k = begin_[near]; k < begin_[near + 1]; ++k) f(points_[at], points_[k]);
          }
  }

 private:
  int neighbour(int x, int y, int z) const {
    int c[3] = {x, y, z};
    for (int d = 0; d < 3; ++d) {
      if (periodic_[d]) c[d] = (c[d] + n_[d]) % n_[d];
      if (c[d] < 0 || c[d] >= n_[d]) return -1;
    }
    return (c[2] * n_[1] + c[1]) * n_[0] + c[0];
  }

  int n_[3] = {1, 1, 1};
  bool periodic_[3] = {false, false, false};
  std::vector<int> begin_, points_;
};

}  // namespace trackbed::dem
