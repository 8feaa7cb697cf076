// Meshes as fuzz_surface draws them: flat ones in any place, with a skirt or a seam, and bent ones.
#pragma once
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "surface_scene.h"
#include "tests/verification/contact_support.h"

namespace trackbed::dem::test {

struct Ground {
  Mesh mesh;  ///< where it stands
  double shell = .1, skirt = 0;
  Vec3 period = Vec3::Zero();
  const char* bent = nullptr;  ///< how
  Mat3 R = Mat3::Identity();   ///< of its own frame, where it is level
  Vec3 x = Vec3::Zero();
  Vec3 at, up;  ///< a grain comes down on this point against `up`
};

/// From -half to half by way of 0, in steps of a cell or, unevenly, of a half and a quarter of it.
inline std::vector<double> any_lines(Random& random, double half, double cell, bool uneven) {
  std::vector<double> lines{0};
  for (const double side : {-1., 1.})
    for (double x = 0; x < half; lines.push_back(side * x))
      x = std::min(half, x + (uneven ? cell / (1 << random.below(3)) : cell));
  std::sort(lines.begin(), lines.end());
  return lines;
}

inline Mesh mesh_of(const std::vector<double>& xs, const std::vector<double>& ys) {
  const int nx = static_cast<int>(xs.size()) - 1, ny = static_cast<int>(ys.size()) - 1;
  Mesh m = flat_mesh(nx, ny, 0, nx, 0, ny);
  for (Vec3& p : m.nodes) p = Vec3(xs[std::lround(p.x())], ys[std::lround(p.y())], 0);
  return m;
}

/// Pushes nodes inside about in the plane, but for those on x = 0.
inline void push_nodes(Random& random, const std::vector<double>& xs, const std::vector<double>& ys,
                       Mesh& m) {
  const auto room = [](const std::vector<double>& lines, double x) {
    const auto i = std::lower_bound(lines.begin(), lines.end(), x);
    return .2 * std::min(*i - *(i - 1), *(i + 1) - *i);
  };
  for (Vec3& p : m.nodes)
    if (p.x() != 0 && p.x() > xs.front() && p.x() < xs.back() && p.y() > ys.front() &&
        p.y() < ys.back()) {
      const double a = room(xs, p.x()), b = room(ys, p.y());
      p += Vec3(random.uniform(-a, a), random.uniform(-b, b), 0);
    }
}

/// Diagonals one way or the other; nodes and quads renumbered, as where the diagonal of a side of
/// the shell runs depends on the numbers.
inline void renumber(Random& random, Mesh& m) {
  std::vector<int> number(m.nodes.size());
  std::iota(number.begin(), number.end(), 0);
  if (random.below(2)) random.shuffle(number), random.shuffle(m.quads);
  const std::vector<Vec3> nodes = m.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) m.nodes[number[i]] = nodes[i];
  const unsigned diagonals = random.below(3);
  for (auto& q : m.quads) {
    for (int& i : q) i = number[i];
    if (diagonals == 1 || (diagonals == 2 && random.below(2)))
      std::rotate(q.begin(), q.begin() + 1, q.end());
  }
}

/// Of a quad with a node not farther than `reach` from the origin: a node, the middle of an edge or
/// of the diagonal, or a point inside one of its facets.
inline Vec3 any_point(Random& random, const Mesh& m, double reach) {
  const auto is_near = [&](int i) { return m.nodes[i].cwiseAbs().maxCoeff() <= reach; };
  const std::array<int, 4>* q;
  do q = &m.quads[random.below(m.quads.size())];
  while (std::none_of(q->begin(), q->end(), is_near));
  const Vec3 &a = m.nodes[(*q)[0]], &b = m.nodes[(*q)[1]], &c = m.nodes[(*q)[2]];
  switch (random.below(4)) {
    case 0:
      return a;
    case 1:
      return (a + b) / 2;
    case 2:
      return (a + c) / 2;
    default:
      return .3 * a + .5 * b + .2 * c;
  }
}

/// A dome, waves, or a fold down along x = 0. A grain comes down on a fold or, from above, on what
/// is left level.
inline void bend(Random& random, double half, Ground& g) {
  static constexpr double heights[] = {1e-14, 1e-11, 1e-8, 1e-4, 1e-3};
  const double small = heights[random.below(5)];
  switch (random.below(3)) {
    case 0: {
      g.bent = "dome";
      const double most = random.below(2) ? .15 : small;
      for (Vec3& p : g.mesh.nodes) p.z() = -most * p.squaredNorm() / (half * half);
      g.at.z() = -most * g.at.squaredNorm() / (half * half);
      break;
    }
    case 1:
      g.bent = "waves";
      for (Vec3& p : g.mesh.nodes) p.z() = small * random.uniform(-1, 1);
      break;
    default: {
      g.bent = "fold";
      static constexpr double angles[] = {1e-14, 1e-8, 1e-3, .1, .3, 1, M_PI / 2};
      const double angle = angles[random.below(7)];
      for (Vec3& p : g.mesh.nodes)
        if (p.x() > 0) p = Vec3(p.x() * std::cos(angle), p.y(), -p.x() * std::sin(angle));
      g.at.x() = random.below(2) ? 0 : -std::abs(g.at.x());
      if (g.at.x() == 0) g.up = rotation(random.uniform(0, angle) * Vec3::UnitY()) * g.up;
    }
  }
}

/// For grains that reach no farther than `reach` from where they come down.
inline Ground any_ground(Random& random, double reach) {
  Ground g;
  enum { kFar, kSkirt, kSeam };
  const unsigned border = random.below(3);
  const bool bent = border == kFar && random.below(2);
  const double cell = .25 * (1 << random.below(5));
  const double half = border == kFar ? std::ceil(reach) + 1 + cell : 1 << random.below(2);
  const bool uneven = cell > .25 && random.below(2);
  const std::vector<double> xs = any_lines(random, half, cell, uneven),
                            ys = any_lines(random, half, cell, uneven);
  g.mesh = mesh_of(xs, ys);
  if (random.below(2)) push_nodes(random, xs, ys, g.mesh);
  renumber(random, g.mesh);
  g.at = any_point(random, g.mesh, border == kFar ? 1 : half);
  g.up = Vec3::UnitZ();
  g.shell = 1. / (2 << random.below(4));
  if (bent) {
    bend(random, half, g);
    g.shell = std::min(g.shell, cell / (uneven ? 16 : 4));
  }
  if (border != kFar) g.skirt = reach + 1;
  if (border == kSeam) {
    g.period = Vec3(2 * half, random.below(2) ? 2 * half : 0, 0);
    return g;
  }
  if (random.below(3)) g.R = random_rotation(random);
  if (random.below(2)) g.x = random.uniform(0, 3) * random.direction();
  for (Vec3& p : g.mesh.nodes) p = g.R * p + g.x;
  g.at = g.R * g.at + g.x, g.up = g.R * g.up;
  return g;
}

}  // namespace trackbed::dem::test
