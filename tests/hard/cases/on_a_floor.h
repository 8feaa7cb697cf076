// What blocks, plain and dilated ones, and balls are measured by where they rest on a floor.
#pragma once
#include "grain_scene.h"

namespace trackbed::hard {

/// Largest relative change of force_at(tilt) over tilts of 1e-14 to 1e-8 rad.
template <class ForceAt>
double change_by_tilt(ForceAt&& force_at) {
  const double upright = force_at(0.);
  double worst = 0;
  for (double angle = 1e-14; angle < 2e-8; angle *= 10)
    worst = std::max(worst, std::abs(force_at(angle) / upright - 1));
  return worst;
}

/// Speed of a block [m/s] after 5000 steps with local damping of 0.5.
inline double speed_at_rest(dem::Scene s) {
  s.context.local_damping = .5;
  for (int k = 0; k < 5000; ++k) s.step();
  return s.bodies.v[0].norm();
}

/// By how much it has turned after 5000 steps [rad].
inline double turned_at_rest(dem::Scene s) {
  const dem::Mat3 start = s.bodies.R[0];
  for (int k = 0; k < 5000; ++k) s.step();
  return (s.bodies.R[0] - start).norm() / std::sqrt(2.);
}

/// How often the contact of a grain that comes down at `speed` [m/s] begins or ends until it is back
/// at height `back` [m]; infinite if it does not return in so many steps.
inline double changes_of_contact(dem::Scene s, const Setting& set, double speed, double back,
                                 int most_steps) {
  s.context.gravity.setZero();
  s.bodies.v[0].z() = -speed;
  s.prepare();
  s.context.dt = set.share * dem::expected_limit(s.bodies, s.shapes, s.materials, {1, 1}).dt;
  int changes = 0;
  bool touching = false;
  for (int k = 0; k < most_steps && !(changes >= 2 && s.bodies.x[0].z() > back); ++k) {
    s.step();
    const bool now = dem::count_contacts(s.pairs) > 0;
    changes += now != touching;
    touching = now;
  }
  return changes < 2 ? HUGE_VAL : changes;
}

/// Work of the force on a held grain on a circle of radius r [m] in z, a hundred times that in x,
/// about `middle`; `stored` [J] at height h [m] over the middle: work over the most that is stored.
/// Trapezoidal sums of a smooth periodic force converge faster than any power of their number.
template <class Stored>
double work_of_closed_path(dem::Scene s, const dem::Vec3& middle, double r, Stored&& stored) {
  const int n = 128;
  double work = 0, most = 0;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * M_PI * k / n;
    s.bodies.x[0] = middle + r * dem::Vec3(100 * std::cos(a), 0, std::sin(a));
    s.prepare();
    work += s.bodies.force[0].dot(dem::Vec3(-100 * std::sin(a), 0, std::cos(a))) * r * 2 * M_PI / n;
    most = std::max(most, stored(s, r * std::sin(a)));
  }
  return most > 0 ? std::abs(work) / most : HUGE_VAL;
}

}  // namespace trackbed::hard
