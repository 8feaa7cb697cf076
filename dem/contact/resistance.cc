#include "dem/contact/resistance.h"

#include <cmath>

#include "dem/contact/friction.h"

namespace trackbed::dem {
namespace {

double rolling_radius(const Bodies& b, const Pairs& pairs, int p) {
  const double ra = pairs.arm_a[p].norm(), rb = pairs.arm_b[p].norm();
  return pairs.b[p] >= b.grains ? ra : ra * rb / (ra + rb);
}

// What the springs held was counted as lost with the contact, as friction's.
void release(Pairs& pairs, int p) {
  pairs.torsion[p] = pairs.torsion_stiffness[p] = pairs.rolling_stiffness[p] = 0;
  pairs.rolling[p].setZero();
}

FrictionResult torsion(double share, const Bodies& b, const PairMaterials& materials, const Vec3& n,
                       const Vec3& turn, Pairs& pairs, int p) {
  const PairMaterial& m = materials(b.material[pairs.a[p]], b.material[pairs.b[p]]);
  const double area = pairs.area[p];
  const double k = tangential_stiffness(m, area) * area / (2 * M_PI);
  const double radius = 2. / 3 * std::sqrt(area / M_PI);
  // One component: a spring in a plane of its own.
  Vec3 moment(pairs.torsion[p], 0, 0);
  const FrictionResult r =
      advance_friction(share * m.friction * radius, k, Vec3(0, 0, 1), pairs.normal_force[p],
                       {Vec3(n.dot(turn), 0, 0), Vec3::Zero()}, moment, pairs.torsion_stiffness[p]);
  pairs.torsion[p] = moment.x();
  pairs.couple[p] += moment.x() * n;
  return r;
}

FrictionResult rolling(double coefficient, const Bodies& b, const Vec3& n, const Vec3& turn,
                       const Vec3& pair_turn, Pairs& pairs, int p) {
  const double arm = coefficient * rolling_radius(b, pairs, p);
  const double k = 2.25 * pairs.stiffness[p] * arm * arm;
  const FrictionResult r = advance_friction(arm, k, n, pairs.normal_force[p], {turn, pair_turn},
                                            pairs.rolling[p], pairs.rolling_stiffness[p]);
  pairs.couple[p] += pairs.rolling[p];
  return r;
}

}  // namespace

void add_resistance(const ResistanceSettings& s, const Bodies& b, const PairMaterials& materials,
                    const StepContext& c, Pairs& pairs) {
  pairs.keep_resistance();
#pragma omp parallel for schedule(static) num_threads(c.threads) if (c.threads > 1)
  for (int p = 0; p < pairs.size(); ++p) {
    if (!pairs.touching[p]) {
      if (pairs.torsion_stiffness[p] > 0 || pairs.rolling_stiffness[p] > 0) release(pairs, p);
      continue;
    }
    const int i = pairs.a[p], j = pairs.b[p];
    const Vec3& n = pairs.axis[p];
    Vec3 turn = Vec3::Zero(), pair_turn = Vec3::Zero();
    if (c.dt > 0) turn = b.turn[i] - b.turn[j], pair_turn = (b.turn[i] + b.turn[j]) / 2;
    FrictionResult sum;
    const auto add = [&sum](const FrictionResult& r) {
      sum.stored += r.stored, sum.dissipated += r.dissipated;
    };
    if (s.torsion > 0) add(torsion(s.torsion, b, materials, n, turn, pairs, p));
    if (s.rolling > 0) add(rolling(s.rolling, b, n, turn, pair_turn, pairs, p));
    pairs.friction_energy[p] += sum.stored;
    pairs.friction_loss[p] += sum.dissipated;
  }
}

}  // namespace trackbed::dem
