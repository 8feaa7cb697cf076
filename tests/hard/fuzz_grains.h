// Grains as the fuzzers draw them, degenerate on purpose, and how they are put in place.
#pragma once
#include <cmath>
#include <vector>

#include "dem/motion/bodies.h"
#include "tests/verification/exact_overlap.h"

namespace trackbed::dem::test {

/// What a judge found, and by how much; nothing: `what` is null.
struct Fault {
  const char* what = nullptr;
  double value = 0;
};

inline Polyhedron any_core(Random& random) {
  while (true) {
    try {
      switch (random.below(4)) {
        case 0:
          return random_hull(random, 4 + static_cast<int>(random.below(16)));
        case 1:
          return make_box({.5 + .125 * random.below(8), .5 + .125 * random.below(8), 1});
        case 2: {  // a prism: faces of many corners
          std::vector<Vec3> points;
          const int corners = 3 + static_cast<int>(random.below(9));
          for (int k = 0; k < corners; ++k)
            for (const double z : {-.4, .4})
              points.emplace_back(std::cos(2 * M_PI * k / corners),
                                  std::sin(2 * M_PI * k / corners), z);
          return convex_hull(points);
        }
        default: {  // needles and flakes with equal and coplanar corners
          std::vector<Vec3> points;
          for (int i = 0; i < 9; ++i)
            points.emplace_back(.25 * (random.below(9) - 4.), .25 * (random.below(9) - 4.),
                                .25 * (random.below(3) - 1.) / (1 + 7. * random.below(2)));
          return convex_hull(points);
        }
      }
    } catch (const std::exception&) {
    }
  }
}

/// Outward direction at a vertex, an edge or a face of a core.
inline Vec3 any_direction(Random& random, const ConvexView& v) {
  const auto normal = [&v](int f) { return Vec3(v.nx[f], v.ny[f], v.nz[f]); };
  const int i = static_cast<int>(random.below(v.vertices));
  const int from = v.neighbor_begin[i], edges = v.neighbor_begin[i + 1] - from;
  const int k = static_cast<int>(random.below(edges));
  Vec3 sum = normal(v.left_face[from + k]);
  const unsigned kind = random.below(3);
  if (kind == 1) sum += normal(v.left_face[from + (k > 0 ? k : edges) - 1]);
  if (kind == 2)
    for (int e = 0; e < edges; ++e) sum += normal(v.left_face[from + e]);
  return sum.normalized();
}

inline double any_tilt(Random& random) {
  static constexpr double tilts[] = {0, 0, 1e-14, 1e-11, 1e-8, 1e-5, 1e-3, 1e-2, .1};
  return tilts[random.below(9)];
}

/// The nearest rotation, as bodies have them: a matrix made by way of two nearly opposite vectors
/// is off one by as much as 1e-12, and a body so turned is not the one that its planes enclose.
inline void place(Bodies& b, int i, const Vec3& x, const Mat3& R) {
  b.x[i] = x, b.q[i] = Quat(R).normalized();
  b.R[i] = b.q[i].toRotationMatrix();
}

/// The planes of a prism, or of a plain body, in doubles as the kernel gets them.
inline std::vector<Plane> planes_of(const ConvexView& v, const Mat3& R, const Vec3& x) {
  std::vector<Plane> all;
  for (int f = 0; f < v.faces; ++f) {
    const Vec3 n = R * Vec3(v.nx[f], v.ny[f], v.nz[f]);
    all.emplace_back(n.x(), n.y(), n.z(), -(v.offset[f] + n.dot(x)));
  }
  return all;
}

}  // namespace trackbed::dem::test
