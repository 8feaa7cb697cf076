#include "dem/motion/energy.h"

#include "dem/motion/ordered_sum.h"

namespace trackbed::dem {
namespace {

double free_part(const Vec3& a, const Vec3& b, int bits) {
  double sum = 0;
  for (int d = 0; d < 3; ++d)
    if (bits >> d & 1) sum += a[d] * b[d];
  return sum;
}

}  // namespace

double kinetic_energy(const Bodies& b) {
  return ordered_sum<double>(b.size(), 1, [&](int i) {
    return (b.mass[i] * free_part(b.v[i], b.v[i], b.freedom[i]) +
            free_part(b.omega[i], b.L[i], b.freedom[i] >> 3)) /
           2;
  });
}

double gravity_energy(const Bodies& b, const Vec3& gravity) {
  return ordered_sum<double>(
      b.size(), 1, [&](int i) { return -b.mass[i] * free_part(gravity, b.x[i], b.freedom[i]); });
}

Energies energies(const Bodies& b, const Pairs& pairs, const Vec3& gravity) {
  Energies e;
  e.kinetic = kinetic_energy(b);
  e.gravity = gravity_energy(b, gravity);
  e.normal = ordered_sum<double>(pairs.size(), 1, [&](int p) { return pairs.energy[p]; });
  e.tangential =
      ordered_sum<double>(pairs.size(), 1, [&](int p) { return pairs.friction_energy[p]; });
  return e;
}

double friction_loss(const Pairs& pairs, int threads) {
  return ordered_sum(pairs.friction_loss.data(), pairs.size(), threads);
}

double viscous_loss(const Pairs& pairs, int threads) {
  const int first = pairs.end(PairKind::polyhedra);  // they have none
  return ordered_sum(pairs.viscous_loss.data() + first, pairs.round(), threads);
}

}  // namespace trackbed::dem
