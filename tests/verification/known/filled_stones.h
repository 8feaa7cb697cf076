// Jin's stones filled with spheres.
#pragma once
#include <cmath>
#include <vector>

#include "dem/grain/clump.h"
#include "dem/grain/jin.h"
#include "dem/grain/random.h"

namespace trackbed::dem::known {

inline std::vector<std::vector<Sphere>> fillings(double least_radius, int stones) {
  Random random(1);
  std::vector<std::vector<Sphere>> all;
  FillingParameters p;
  p.least_radius = least_radius, p.space_factor = 1.15;
  for (int k = 0; k < stones; ++k) all.push_back(fill_with_spheres(jin_stone({}, random), p));
  return all;
}

struct Filling {
  double error;    ///< 1 - trace of the inertia over the stone's, mean
  double spheres;  ///< mean
};

/// What of the stones' inertia their spheres leave out.
inline Filling missing_inertia(const std::vector<std::vector<Sphere>>& clumps) {
  Random random(1);
  Filling f{0, 0};
  for (const auto& clump : clumps) {
    const double exact = mass_properties(jin_stone({}, random)).inertia.trace();
    f.error += (1 - mass_properties(clump).inertia.trace() / exact) / double(clumps.size());
    f.spheres += double(clump.size()) / double(clumps.size());
  }
  return f;
}

}  // namespace trackbed::dem::known
