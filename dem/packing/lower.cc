#include "dem/packing/lower.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dem/contact/overlap.h"

namespace trackbed::dem {
namespace {

double lowest_point(const Bodies& b, const ShapeTable& shapes, int i) {
  double low = std::numeric_limits<double>::infinity();
  for (const Vec3& p : shapes.shape(b.shape[i]).body.vertices)
    low = std::min(low, b.x[i].z() + b.R[i].row(2).dot(p));
  return low;
}

}  // namespace

double free_fall(const ConvexView& a, const Pose& from, const ConvexView& b, const Pose& pb,
                 double limit) {
  Vec3 axis = pb.x - from.x;
  double way = 0;
  for (int step = 0; step < 1000 && way < limit; ++step) {
    const Pose pa{from.R, from.x - Vec3(0, 0, way)};
    const double gap = separating_axis(a, pa, b, pb, axis);
    const double closing = -axis.z();  // of the gap along the axis, per way down
    if (gap <= 0) return way;
    if (closing <= 1e-12 || gap / closing >= limit - way) return limit;
    // A hair past where this axis stops to separate, so that another one is looked for.
    way += gap / closing + 1e-9 * a.radius;
  }
  return std::min(way, limit);
}

void lower_grains(Bodies& b, const ShapeTable& shapes, int first, double floor, const Vec3& period,
                  double clearance) {
  std::vector<int> order(b.grains - first);
  std::iota(order.begin(), order.end(), first);
  std::sort(order.begin(), order.end(),
            [&](int i, int j) { return std::pair(b.x[i].z(), i) < std::pair(b.x[j].z(), j); });
  std::vector<char> settled(b.grains, 0);
  std::fill(settled.begin(), settled.begin() + first, 1);
  for (const int i : order) {
    double way = lowest_point(b, shapes, i) - floor;
    const double radius = shapes.shape(b.shape[i]).radius;
    for (int j = 0; j < b.grains; ++j) {
      if (!settled[j]) continue;
      Vec3 apart = b.x[j] - b.x[i], shift = Vec3::Zero();
      for (int k = 0; k < 2; ++k)
        if (period[k] > 0) shift[k] = -period[k] * std::round(apart[k] / period[k]);
      apart += shift;
      const double reach = radius + shapes.shape(b.shape[j]).radius;
      if (apart.head<2>().squaredNorm() >= reach * reach || apart.z() > reach ||
          -apart.z() > way + reach)
        continue;
      way = std::min(way, free_fall(shapes.view(b.shape[i]), {b.R[i], b.x[i]},
                                    shapes.view(b.shape[j]), {b.R[j], b.x[j] + shift}, way));
    }
    b.x[i].z() -= std::max(0.0, way - clearance);
    settled[i] = 1;
  }
}

}  // namespace trackbed::dem
