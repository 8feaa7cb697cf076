#include "fem/contact_bound.h"

#include <algorithm>
#include <cmath>

namespace trackbed::fem {
namespace {

constexpr int kIterations = 15;
constexpr double kSafe = 1.05;

double inner(const std::vector<Vec>& a, const std::vector<Vec>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int d = 0; d < 3; ++d) sum += a[i][d] * b[i][d];
  return sum;
}

}  // namespace

double largest_contact_eigenvalue(const std::vector<NodeSpring>& springs, int nodes,
                                  const SurfaceResponse& respond) {
  if (springs.empty()) return 0;
  std::vector<Vec> force(nodes, Vec{}), moved(nodes, Vec{});
  for (const NodeSpring& s : springs)  // any start, always the same
    for (int d = 0; d < 3; ++d)
      force[s.node][d] = s.largest * std::sin(1. + 7.13 * (3 * s.node + d));
  double value = 0;
  for (int n = 0; n < kIterations; ++n) {
    respond(force, moved);
    const double mass = inner(force, moved);  // xᵀ M x of x = M⁻¹ f
    if (!(mass > 0)) return 0;
    const double scale = 1 / std::sqrt(mass);
    std::fill(force.begin(), force.end(), Vec{});
    for (const NodeSpring& s : springs)
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          force[s.node][r] += scale * s.stiffness[r][c] * moved[s.node][c];
    value = scale * inner(force, moved);  // xᵀ S x / xᵀ M x
  }
  return kSafe * value;
}

}  // namespace trackbed::fem
