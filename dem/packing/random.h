// Random numbers that are the same on every machine: the standard fixes the bits of mt19937_64,
// but not what its distributions make of them.
#pragma once
#include <cmath>
#include <cstdint>
#include <random>

#include "dem/types.h"

namespace trackbed::dem {

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }  ///< [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform over all rotations (Shoemake 1992).
  Quat rotation() {
    const double u = uniform(), a = 2 * M_PI * uniform(), b = 2 * M_PI * uniform();
    const double s = std::sqrt(1 - u), t = std::sqrt(u);
    return Quat(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b));
  }

 private:
  std::mt19937_64 bits_;
};

}  // namespace trackbed::dem
