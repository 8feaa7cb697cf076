#include "dem/packing/equilibrium.h"

#include <limits>

namespace trackbed::dem {

double unbalanced_share(const Bodies& b, const Pairs& pairs, const Vec3& gravity) {
  double resultant = 0, contact = 0;
  int contacts = 0;
  for (int i = 0; i < b.grains; ++i)
    resultant += (b.force[i] + b.applied_force[i] + b.mass[i] * gravity).norm();
  for (int p = 0; p < pairs.size(); ++p)
    if (pairs.touching[p]) contact += pairs.force[p].norm(), ++contacts;
  if (contacts == 0 || contact == 0) return std::numeric_limits<double>::infinity();
  return resultant / b.grains * contacts / contact;
}

}  // namespace trackbed::dem
