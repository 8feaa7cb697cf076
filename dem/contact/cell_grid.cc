#include "dem/contact/cell_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "base/error.h"

namespace trackbed::dem {

CellGrid::CellGrid(const Vec3* x, int points, double width, const Vec3& period) {
  Vec3 low = Vec3::Zero(), extent = Vec3::Zero();
  if (points > 0) {
    Vec3 high = low = x[0];
    for (int i = 1; i < points; ++i) low = low.cwiseMin(x[i]), high = high.cwiseMax(x[i]);
    extent = high - low;
  }
  if (!extent.allFinite()) throw RunError("a grain's place is not a number");
  for (int d = 0; d < 3; ++d) {
    periodic_[d] = period[d] > 0;
    if (periodic_[d]) extent[d] = period[d];
    n_[d] = width > 0 ? static_cast<int>(std::clamp(std::floor(extent[d] / width), 1., 1e4)) : 1;
    if (periodic_[d] && width > 0 && n_[d] < 3)
      throw InputError("the periodic length " + std::to_string(period[d]) +
                       " m is less than three of the largest grains (" + std::to_string(width) +
                       " m each)");
  }
  // A few scattered grains must not cost memory: fewer, wider cells.
  while (double(n_[0]) * n_[1] * n_[2] > 8. * points + 4096) {
    int* most = std::max_element(n_, n_ + 3);
    *most = std::max(*most / 2, 3);
  }
  std::vector<int> cell(points);
  for (int i = 0; i < points; ++i) {
    int c[3];
    for (int d = 0; d < 3; ++d) {
      const double at = extent[d] > 0 ? (x[i][d] - low[d]) / extent[d] * n_[d] : 0;
      const int k = static_cast<int>(std::floor(at));
      c[d] = periodic_[d] ? ((k % n_[d]) + n_[d]) % n_[d] : std::clamp(k, 0, n_[d] - 1);
    }
    cell[i] = (c[2] * n_[1] + c[1]) * n_[0] + c[0];
  }
  begin_.assign(cells() + 1, 0);
  for (int i = 0; i < points; ++i) ++begin_[cell[i] + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  points_.resize(points);
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (int i = 0; i < points; ++i) points_[next[cell[i]]++] = i;
}

}  // namespace trackbed::dem
