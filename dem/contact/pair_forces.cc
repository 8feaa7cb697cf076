#include "dem/contact/pair_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "dem/contact/fetch.h"

namespace trackbed::dem {

PairMaterials::PairMaterials(int materials) : n_(materials) {
  PairMaterial unset;
  unset.modulus = std::numeric_limits<double>::quiet_NaN();
  table_.assign(materials * materials, unset);
}

void PairMaterials::set(int i, int j, const PairMaterial& m) {
  if (!(m.modulus > 0) || !(m.friction >= 0) || !(m.tangential_ratio >= 0))
    throw InputError("pair of materials " + std::to_string(i) + ", " + std::to_string(j) +
                     ": modulus must be positive, friction and tangential ratio not negative");
  table_.at(i * n_ + j) = table_.at(j * n_ + i) = m;
  damped_ = std::any_of(table_.begin(), table_.end(), [](auto& of) { return of.damping > 0; });
}

bool PairMaterials::has_friction() const {
  for (const PairMaterial& m : table_)
    if (m.friction > 0 && m.tangential_ratio > 0) return true;
  return false;
}

void sum_forces(const Pairs& pairs, const StepContext& c, Bodies& b) {
  constexpr int kAhead = 100;
  const int threads = c.threads_for(b.size());
  const bool many = pairs.size() > kManyPairs;
  // Pairs of balls have no couple unless something resists their turning.
  const int balls = pairs.begin(PairKind::balls),
            others = pairs.resists ? balls : pairs.end(PairKind::points);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (int i = 0; i < b.size(); ++i) {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (int k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
      const int e = pairs.incident[k];
      const int p = e >= 0 ? e : ~e;
      // A pair is first met at its body a, in order; soon after, or a layer of grains later, at b.
      if (many && e >= 0 && p + kAhead < pairs.size())
        for (const auto* v : {&pairs.force, &pairs.arm_a, &pairs.arm_b})
          fetch_lines(&(*v)[p + kAhead], 1);
      if (!pairs.touching[p]) continue;
      const bool couple = p < balls || p >= others;
      if (e >= 0) {
        force += pairs.force[p];
        torque += pairs.arm_a[p].cross(pairs.force[p]);
        if (couple) torque += pairs.couple[p];
      } else {
        force -= pairs.force[p];
        torque -= pairs.arm_b[p].cross(pairs.force[p]);
        if (couple) torque -= pairs.couple[p];
      }
    }
    b.force[i] = force;
    b.torque[i] = torque;
  }
}

void forget_friction(Pairs& pairs) {
  for (int p = 0; p < pairs.size(); ++p) {
    pairs.friction[p].setZero();
    pairs.friction_stiffness[p] = 0;
  }
}

}  // namespace trackbed::dem
