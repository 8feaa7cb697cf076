#include "dem/grain/jin.h"

#include <cmath>
#include <map>

#include "base/error.h"

namespace trackbed::dem {
namespace {

// Surface of the cube [0, n]^3 in unit squares, each cut in two.
TriangleSolid divided_cube(int n) {
  TriangleSolid cube;
  std::map<std::array<int, 3>, int> number;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [it, fresh] = number.emplace(at, int(cube.vertices.size()));
    if (fresh) cube.vertices.emplace_back(at[0], at[1], at[2]);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side : {0, n})
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) {
          const auto corner = [&](int da, int db) {
            std::array<int, 3> at;
            at[axis] = side, at[(axis + 1) % 3] = a + da, at[(axis + 2) % 3] = b + db;
            return node(at);
          };
          int q[4] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
          if (side == 0) std::swap(q[1], q[3]);
          const int k = (a + b) % 2;
          cube.triangles.push_back({q[k], q[k + 1], q[k + 2]});
          cube.triangles.push_back({q[k], q[k + 2], q[(k + 3) % 4]});
        }
  return cube;
}

void check(const JinParameters& p) {
  for (double edge : {p.length, p.width, p.height})
    if (!(edge > 0) || !std::isfinite(edge))
      throw InputError("Jin's stones: L, W, H must be positive");
  if (p.divisions < 1) throw InputError("Jin's stones: N_d must be at least 1");
  if (!(p.least_scale > 0 && p.least_scale <= p.largest_scale) || !std::isfinite(p.largest_scale))
    throw InputError("Jin's stones: S_l and S_u must satisfy 0 < S_l <= S_u");
}

double normal(Random& random) {  // Box and Muller
  const double r = std::sqrt(-2 * std::log(1 - random.uniform()));
  return r * std::cos(2 * M_PI * random.uniform());
}

}  // namespace

TriangleSolid jin_stone(const JinParameters& p, Random& random) {
  check(p);
  TriangleSolid stone = divided_cube(p.divisions);
  const Vec3 edges(p.length, p.width, p.height);
  for (Vec3& v : stone.vertices) {
    v = edges.cwiseProduct(v / double(p.divisions) - Vec3::Constant(0.5));
    v *= random.uniform(p.least_scale, p.largest_scale);
  }
  return stone;
}

double draw(const LogNormal& d, Random& random) {
  return d.median * std::exp(d.deviation * normal(random));
}

LogNormal fit_log_normal(const std::vector<double>& values) {
  if (values.size() < 2) throw InputError("log-normal fit: at least two values are needed");
  double mean = 0, squares = 0;
  for (double v : values) {
    if (!(v > 0)) throw InputError("log-normal fit: every value must be positive");
    mean += std::log(v) / double(values.size());
  }
  for (double v : values) squares += std::pow(std::log(v) - mean, 2);
  return {std::exp(mean), std::sqrt(squares / double(values.size() - 1))};
}

std::vector<TriangleSolid> jin_stones(const JinStonesParameters& p) {
  if (p.count < 1) throw InputError("Jin's stones: count must be at least 1");
  const LogNormal& ratio = p.length_over_height;
  if (!(ratio.median > 0) || !(ratio.deviation >= 0) ||
      ratio.median * std::exp(2 * ratio.deviation) < 1)
    throw InputError("Jin's stones: L/H needs a median near or above 1 and a deviation >= 0");
  Random random(p.seed);
  std::vector<TriangleSolid> stones;
  for (int k = 0; k < p.count; ++k) {
    double l_over_h = draw(ratio, random);
    while (l_over_h < 1) l_over_h = draw(ratio, random);
    JinParameters stone;
    stone.width = 1;
    stone.height = std::pow(l_over_h, -random.uniform());
    stone.length = l_over_h * stone.height;
    stone.divisions = p.divisions;
    stone.least_scale = p.least_scale, stone.largest_scale = p.largest_scale;
    stones.push_back(jin_stone(stone, random));
  }
  return stones;
}

}  // namespace trackbed::dem
