// The least square hole a body passes, by brute force: random orientations, the best of them
// improved by random turns. Shares nothing with the code it judges. A body needs a width(body, d)
// of its extent along d.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "dem/grain/clump.h"
#include "dem/grain/polyhedron.h"
#include "dem/grain/random.h"

namespace trackbed::dem {

inline double width(const Polyhedron& body, const Vec3& d) {
  double low = 1e300, high = -1e300;
  for (const Vec3& v : body.vertices)
    low = std::min(low, v.dot(d)), high = std::max(high, v.dot(d));
  return high - low;
}

inline double width(const std::vector<Sphere>& spheres, const Vec3& d) {
  double low = 1e300, high = -1e300;
  for (const Sphere& s : spheres) {
    high = std::max(high, s.centre.dot(d) + s.radius);
    low = std::min(low, s.centre.dot(d) - s.radius);
  }
  return high - low;
}

template <class Body>
double brute_force(const Body& body, std::uint64_t seed) {
  Random random(seed);
  const auto value = [&](const Quat& q) {
    return std::max(width(body, q * Vec3::UnitX()), width(body, q * Vec3::UnitY()));
  };
  const auto random_turn = [&](double angle) {
    return Quat(Eigen::AngleAxisd(angle * random.uniform(), random.direction()));
  };
  std::vector<std::pair<double, Quat>> frames;
  for (int k = 0; k < 20000; ++k) {
    const Quat q = random_turn(2 * M_PI) * random_turn(M_PI);
    frames.emplace_back(value(q), q);
  }
  std::partial_sort(frames.begin(), frames.begin() + 25, frames.end(),
                    [](const auto& a, const auto& b) { return a.first < b.first; });
  double best = 1e300;
  for (int k = 0; k < 25; ++k) {
    auto [here, q] = frames[k];
    for (double step = 0.1; step > 1e-9;) {
      bool moved = false;
      for (int t = 0; t < 200 && !moved; ++t) {
        const Quat next = (random_turn(step) * q).normalized();
        const double there = value(next);
        if (there < here) here = there, q = next, moved = true;
      }
      if (!moved) step *= 0.8;
    }
    best = std::min(best, here);
  }
  return best;
}

}  // namespace trackbed::dem
