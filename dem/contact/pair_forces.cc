#include "dem/contact/pair_forces.h"

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
}

bool PairMaterials::has_friction() const {
  for (const PairMaterial& m : table_)
    if (m.friction > 0 && m.tangential_ratio > 0) return true;
  return false;
}

namespace {

/// Asks for what the sum below reads of a pair at one of its bodies.
[[gnu::always_inline]] inline void fetch_end(const Pairs& pairs, int e) {
  const int p = e >= 0 ? e : ~e;
  fetch(pairs.force[p]), fetch((e >= 0 ? pairs.arm_a : pairs.arm_b)[p]);
}

}  // namespace

void sum_forces(const Pairs& pairs, const StepContext& c, Bodies& b) {
  constexpr int kAhead = 200;
  const int threads = c.threads_for(b.size()), ends = static_cast<int>(pairs.incident.size());
  const bool many = ends > 2 * kManyPairs;
  // Pairs of balls have no couple unless something resists their turning.
  const int balls = pairs.begin(PairKind::balls),
            others = pairs.resists ? balls : pairs.end(PairKind::points);
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (int i = 0; i < b.size(); ++i) {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (int k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
      if (many && k + kAhead < ends) fetch_end(pairs, pairs.incident[k + kAhead]);
      const int e = pairs.incident[k];
      const int p = e >= 0 ? e : ~e;
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
