#include "coupling/time_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace trackbed::coupling {
namespace {

using dem::Mat3;
using dem::Vec3;

/// A grain's end of its contact with a surface that may give way.
dem::ContactShare share_of(const dem::PatchContacts& k, int i) {
  return {2,
          k.stiffness[i],
          k.friction_stiffness[i],
          k.tilt_stiffness[i],
          k.normal_force[i].normalized(),
          k.arm[i]};
}

dem::FurtherContacts contacts_with_surfaces(const World& w) {
  dem::FurtherContacts all;
  all.first.assign(w.bodies.size() + 1, 0);
  for (const Surface& s : w.surfaces)
    for (int i = 0; i < s.contacts.size(); ++i)
      if (s.contacts.touching[i]) ++all.first[s.contacts.grain[i] + 1];
  for (int i = 0; i < w.bodies.size(); ++i) all.first[i + 1] += all.first[i];
  all.contact.resize(all.first.back());
  std::vector<int> next = all.first;
  for (const Surface& s : w.surfaces)
    for (int i = 0; i < s.contacts.size(); ++i)
      if (s.contacts.touching[i])
        all.contact[next[s.contacts.grain[i]]++] = share_of(s.contacts, i);
  return all;
}

/// The surface's end: twice the contacts' stiffness, by the share of force that each node takes.
std::vector<fem::NodeSpring> springs_on(const Surface& s) {
  const dem::PatchContacts& k = s.contacts;
  const std::vector<int>& same_as = s.structure->surface().same_as;
  std::vector<Mat3> at(s.patch.carried, Mat3::Zero());
  for (int i = 0; i < k.size(); ++i) {
    if (!k.touching[i]) continue;
    double total = 0;
    for (const auto& [node, force] : k.nodal[i]) total += force.norm();
    if (!(total > 0)) continue;
    const Vec3 n = k.normal_force[i].normalized();
    const Mat3 normal = n * n.transpose(), tangent = Mat3::Identity() - normal;
    const Mat3 K = 2 * (k.stiffness[i] * normal + k.friction_stiffness[i] * tangent);
    for (const auto& [node, force] : k.nodal[i])
      at[same_as[s.patch.master[node]]] += force.norm() / total * K;
  }
  std::vector<fem::NodeSpring> springs;
  for (int i = 0; i < s.patch.carried; ++i) {
    if (at[i].isZero(0)) continue;
    fem::NodeSpring spring{i, {}, 0};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) spring.stiffness[r][c] = at[i](r, c);
    spring.largest =
        Eigen::SelfAdjointEigenSolver<Mat3>(at[i], Eigen::EigenvaluesOnly).eigenvalues()[2];
    springs.push_back(spring);
  }
  return springs;
}

/// Of the step that an explicit surface bears, what one bears that a solve moves elsewhere than
/// predicted: two masses grow there by at most 1e-3 a step, whatever they stand on.
constexpr double kPredictedShare = 1. / 3;

/// omega of the steps that a surface with these springs allows.
double surface_omega(const World& w, const Surface& s) {
  const double omega = std::sqrt(s.structure->contact_bound(springs_on(s)));
  const double own = s.structure->explicit_limit();
  if (w.exchange.schedule != Schedule::predicted || omega * own >= 2) return omega;
  const double solved = omega / kPredictedShare;
  return own > 0 ? std::min(solved, 2 / own) : solved;
}

}  // namespace

dem::TimeStepLimit measured_limit(const World& w, int threads) {
  if (w.surfaces.empty()) return dem::measured_limit(w.bodies, w.pairs, threads);
  const dem::FurtherContacts with_surfaces = contacts_with_surfaces(w);
  dem::TimeStepLimit limit = dem::measured_limit(w.bodies, w.pairs, threads, with_surfaces);
  double surface = 0;  // omega
  for (const Surface& s : w.surfaces) surface = std::max(surface, surface_omega(w, s));
  if (surface > limit.omega) limit = {2 / surface, -1, surface, 0};
  const int steps = steps_per_exchange(w);
  if (steps > 1) {
    dem::Pairs none;
    none.first.assign(w.bodies.size() + 1, 0);
    const double grains = dem::measured_limit(w.bodies, none, threads, with_surfaces).omega;
    limit.dt = std::min(limit.dt, 2 / (steps * std::max(grains, surface)));
  }
  return limit;
}

}  // namespace trackbed::coupling
