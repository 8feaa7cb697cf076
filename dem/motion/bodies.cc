#include "dem/motion/bodies.h"

#include <cmath>
#include <string>

#include "base/error.h"

namespace trackbed::dem {

int add_body(Bodies& b, int shape, int material, double mass, const Vec3& inertia, const Vec3& x,
             const Quat& q, std::uint8_t freedom) {
  const int i = b.size();
  const std::string name = "body " + std::to_string(i);
  if (!(mass > 0) || !std::isfinite(mass))
    throw InputError(name + ": mass must be positive, got " + std::to_string(mass) + " kg");
  if (!(inertia.minCoeff() > 0) || !inertia.allFinite())
    throw InputError(name + ": principal moments of inertia must be positive");
  if (!x.allFinite() || !q.coeffs().allFinite() || !(q.norm() > 0))
    throw InputError(name + ": place or orientation is not a number");
  const int turns = freedom & (kTurnX | kTurnY | kTurnZ);
  const bool none_one_or_all = turns == 0 || turns == kTurnX || turns == kTurnY ||
                               turns == kTurnZ || turns == (kTurnX | kTurnY | kTurnZ);
  if (!none_one_or_all)
    throw InputError(name +
                     ": a body turns freely, about one axis, or not at all; two of three "
                     "axes is not offered");
  const Quat unit = q.normalized();
  b.x.push_back(x);
  b.q.push_back(unit);
  b.R.push_back(unit.toRotationMatrix());
  for (auto* zero : {&b.v, &b.L, &b.omega, &b.turn, &b.force, &b.torque, &b.applied_force})
    zero->push_back(Vec3::Zero());
  b.mass.push_back(mass);
  b.inertia.push_back(inertia);
  b.shape.push_back(shape);
  b.material.push_back(material);
  b.freedom.push_back(freedom);
  return i;
}

}  // namespace trackbed::dem
