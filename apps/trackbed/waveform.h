// The load within a cycle: from `least` to `largest` and back in one period.
#pragma once
#include <cmath>
#include <string>

namespace trackbed::apps {

/// Load [N] at time t [s] since the cycles began. "sine": least + (largest - least)(1 - cos
/// 2πt/T)/2, which is also called haversine; "triangle": straight flanks with the same ends.
inline double waveform_load(const std::string& waveform, double t, double period, double least,
                            double largest) {
  const double phase = t / period - std::floor(t / period);
  const double share = waveform == "triangle" ? 1 - std::abs(1 - 2 * phase)
                                              : 0.5 * (1 - std::cos(2 * M_PI * t / period));
  return least + (largest - least) * share;
}

}  // namespace trackbed::apps
