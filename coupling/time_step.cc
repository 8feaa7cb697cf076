#include "coupling/time_step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace trackbed::coupling {
namespace {

using dem::Mat3;
using dem::Vec3;
using Mat6 = Eigen::Matrix<double, 6, 6>;

// Adds a contact's share to a grain's bound, as dem::measured_limit does for pairs.
void add_contact(const dem::PatchContacts& k, int i, Mat6& sum) {
  const Vec3 n = k.normal_force[i].normalized();
  const Mat3 normal = n * n.transpose(), tangent = Mat3::Identity() - normal;
  const Mat3 K = k.stiffness[i] * normal + k.friction_stiffness[i] * tangent;
  Mat3 C;  // velocity of the contact point = v - C omega
  const Vec3& r = k.arm[i];
  C << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  sum.topLeftCorner<3, 3>() += 2 * K;
  sum.topRightCorner<3, 3>() -= 2 * K * C;
  sum.bottomLeftCorner<3, 3>() -= 2 * C.transpose() * K;
  sum.bottomRightCorner<3, 3>() += 2 * (C.transpose() * K * C + k.tilt_stiffness[i] * tangent);
}

// Largest omega^2 of a grain; directions in which it does not move left out.
double grain_omega2(const dem::Bodies& b, int g, const Mat6& sum) {
  Mat6 root = Mat6::Zero();  // M^-1/2
  for (int d = 0; d < 3; ++d) root(d, d) = (b.freedom[g] >> d & 1) / std::sqrt(b.mass[g]);
  if (b.freedom[g] >> 3)
    root.bottomRightCorner<3, 3>() =
        b.R[g] * b.inertia[g].cwiseSqrt().cwiseInverse().asDiagonal() * b.R[g].transpose();
  const Mat6 bound = root * sum * root;
  return Eigen::SelfAdjointEigenSolver<Mat6>(bound, Eigen::EigenvaluesOnly).eigenvalues()[5];
}

}  // namespace

dem::TimeStepLimit measured_limit(const World& w, int threads) {
  dem::TimeStepLimit limit = dem::measured_limit(w.bodies, w.pairs, threads);
  const dem::Bodies& b = w.bodies;
  double surface = 0;  // omega^2
  int body = -1;
  std::vector<int> touched;  // grains, once each
  std::vector<int> place(b.grains, -1);
  std::vector<Mat6> sums;
  for (const Surface& s : w.surfaces) {
    const dem::PatchContacts& k = s.contacts;
    std::vector<double> node(s.patch.carried, 0.0);
    for (int i = 0; i < k.size(); ++i) {
      if (!k.touching[i]) continue;
      int& at = place[k.grain[i]];
      if (at < 0) {
        at = static_cast<int>(sums.size());
        sums.push_back(Mat6::Zero());
        touched.push_back(k.grain[i]);
      }
      add_contact(k, i, sums[at]);
      for (const auto& [n, force] : k.nodal[i])
        node[s.patch.master[n]] +=
            k.stiffness[i] * force.norm() / std::max(k.force[i].norm(), 1e-300);
    }
    double stiffest = 0;
    for (const double sum : node) stiffest = std::max(stiffest, sum);
    surface = std::max(surface, 2 * stiffest / s.structure->least_surface_mass());
  }
  for (std::size_t j = 0; j < touched.size(); ++j) {
    const double omega2 = grain_omega2(b, touched[j], sums[j]);
    if (omega2 > surface) surface = omega2, body = touched[j];
  }
  if (surface == 0) return limit;
  if (std::sqrt(surface) > limit.omega) limit.body = body;
  limit.omega = std::sqrt(limit.omega * limit.omega + surface);
  limit.dt = std::min(2 / limit.omega, 2 / (steps_per_exchange(w) * std::sqrt(surface)));
  return limit;
}

}  // namespace trackbed::coupling
