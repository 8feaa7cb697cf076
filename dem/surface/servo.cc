#include "dem/surface/servo.h"

#include <cmath>

namespace trackbed::dem {
namespace {

constexpr double kShare = 0.5;  // of the error that one step takes away
constexpr double kSteps = 200;  // in which the drift takes over

}  // namespace

double wall_stiffness(const Pairs& pairs, int body, const Vec3& axis) {
  double sum = 0;
  for (int k = pairs.first[body]; k < pairs.first[body + 1]; ++k) {
    const int e = pairs.incident[k], p = e >= 0 ? e : ~e;
    if (pairs.touching[p]) sum += pairs.stiffness[p] * std::pow(pairs.axis[p].dot(axis), 2);
  }
  return sum;
}

double servo_speed(double target, double force, double stiffness, double dt, double fastest,
                   double& drift) {
  if (!(stiffness > 0)) return fastest;
  const double speed = kShare * (target - force) / (stiffness * dt);
  const double next = drift + speed / kSteps;
  if (std::abs(speed + next) > fastest) return std::copysign(fastest, speed + next);
  drift = next;
  return speed + drift;
}

}  // namespace trackbed::dem
