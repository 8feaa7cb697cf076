// Random numbers that are the same on every platform for a seed: the standard fixes the bits of
// mt19937_64 but not those of its distributions, so these are our own.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}

  /// Uniform in [0, 1), 53 bits.
  double uniform() { return double(bits_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform in 0 … n-1, n > 0; without bias (rejection).
  std::uint64_t below(std::uint64_t n) {
    const std::uint64_t rest = (~std::uint64_t{0} % n + 1) % n;  // 2^64 mod n
    std::uint64_t r = bits_();
    while (r < rest) r = bits_();
    return r % n;
  }

  /// Uniform on the unit sphere (rejection in the cube: square roots only, no libm).
  Vec3 direction() {
    while (true) {
      const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
      const Vec3 p(x, y, z);
      const double r2 = p.squaredNorm();
      if (r2 <= 1 && r2 > 1e-4) return p / std::sqrt(r2);
    }
  }

  /// Fisher-Yates.
  template <class T>
  void shuffle(std::vector<T>& items) {
    for (std::uint64_t k = items.size(); k > 1; --k) std::swap(items[k - 1], items[below(k)]);
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace trackbed::dem
