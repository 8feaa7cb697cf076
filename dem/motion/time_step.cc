#include "dem/motion/time_step.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "dem/contact/friction.h"

namespace trackbed::dem {
namespace {

using Mat6 = Eigen::Matrix<double, 6, 6>;

Mat3 cross_matrix(const Vec3& r) {
  Mat3 m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

/// M^-1/2 in the directions that are free, world axes; 0 in the others.
void inverse_root_mass(const Bodies& b, int i, Vec3& move, Mat3& turn) {
  const int f = b.freedom[i];
  for (int d = 0; d < 3; ++d) move[d] = (f >> d & 1) / std::sqrt(b.mass[i]);
  turn.setZero();
  if ((f >> 3) == 7) {
    turn = b.R[i] * b.inertia[i].cwiseSqrt().cwiseInverse().asDiagonal() * b.R[i].transpose();
  } else {
    const Mat3 inertia = world_inertia(b, i);
    for (int d = 0; d < 3; ++d)
      if (f >> (3 + d) & 1) turn(d, d) = 1 / std::sqrt(inertia(d, d));
  }
}

/// Of a symmetric, positive semidefinite matrix, from above and at most 2.9 % too large:
/// (tr A^64)^(1/64), by six squarings.
double largest_eigenvalue(const Mat6& a) {
  const double size = a.trace();
  if (!(size > 0)) return 0;
  Mat6 power = a / size;
  double log_scale = 0;  // A^(2^k) = size^(2^k) exp(log_scale) power
  for (int k = 0; k < 6; ++k) {
    power = (power * power).eval();
    const double t = power.trace();
    power /= t;
    log_scale = 2 * log_scale + std::log(t);
  }
  return size * std::exp(log_scale / 64);
}

void add(const ContactShare& c, Mat6& sum) {
  const Mat3 normal = c.normal * c.normal.transpose(), tangent = Mat3::Identity() - normal;
  const Mat3 K = c.normal_stiffness * normal + c.friction_stiffness * tangent;
  const Mat3 C = cross_matrix(c.arm);  // v_c = v - C omega
  sum.topLeftCorner<3, 3>() += c.split * K;
  sum.topRightCorner<3, 3>() -= c.split * K * C;
  sum.bottomRightCorner<3, 3>() += c.split * (C.transpose() * K * C + c.tilt * tangent);
}

/// Largest eigenvalue of a body's bound [1/s2] and its number of contacts.
double body_bound(const Bodies& b, const Pairs& pairs, const FurtherContacts& further, int i,
                  int& contacts) {
  Mat6 sum = Mat6::Zero();
  contacts = 0;
  for (int k = pairs.first[i]; k < pairs.first[i + 1]; ++k) {
    const int e = pairs.incident[k], p = e >= 0 ? e : ~e;
    if (!pairs.touching[p]) continue;
    ++contacts;
    const int other = e >= 0 ? pairs.b[p] : pairs.a[p];
    add({b.freedom[other] == kFixed ? 1. : 2., pairs.stiffness[p], pairs.friction_stiffness[p],
         pairs.tilt_stiffness[p], pairs.axis[p], e >= 0 ? pairs.arm_a[p] : pairs.arm_b[p]},
        sum);
  }
  if (!further.first.empty())
    for (int k = further.first[i]; k < further.first[i + 1]; ++k, ++contacts)
      add(further.contact[k], sum);
  if (contacts == 0) return 0;
  sum.bottomLeftCorner<3, 3>() = sum.topRightCorner<3, 3>().transpose();
  Vec3 move;
  Mat3 turn;
  inverse_root_mass(b, i, move, turn);
  Mat6 root = Mat6::Zero();
  root.topLeftCorner<3, 3>() = move.asDiagonal();
  root.bottomRightCorner<3, 3>() = turn;
  return largest_eigenvalue(root * sum * root);
}

double largest_face(const Polyhedron& body) {
  double most = 0;
  for (const auto& face : body.faces) {
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 2; k < face.size(); ++k)
      area += (body.vertices[face[k - 1]] - body.vertices[face[0]])
                  .cross(body.vertices[face[k]] - body.vertices[face[0]]) /
              2;
    most = std::max(most, area.norm());
  }
  return most;
}

TimeStepLimit limit_of(int body, double omega2, int contacts) {
  return {omega2 > 0 ? 2 / std::sqrt(omega2) : HUGE_VAL, body, std::sqrt(omega2), contacts};
}

/// k and tilt stiffness of the stiffest contact to expect of a shape, per unit modulus.
struct ExpectedStiffness {
  double normal = 0;  // [m]
  double tilt = 0;    // [m3]
};

ExpectedStiffness expected_stiffness(const GrainShape& shape, const ContactExpectation& expect) {
  ExpectedStiffness k;
  if (shape.parts.empty())
    k.normal = kShaoFactor * std::sqrt(expect.area_share * largest_face(shape.body));
  for (const ConvexPart& part : shape.parts) {
    if (part.radius == 0) {
      k.normal =
          std::max(k.normal, kShaoFactor * std::sqrt(expect.area_share * largest_face(part.core)));
      continue;
    }
    const double overlap = expect.overlap * shape.radius;
    k.normal = std::max(k.normal, 2 * std::sqrt(part.radius * overlap));
    if (expect.flat_faces && !part.core.faces.empty())
      k.normal =
          std::max(k.normal, kShaoFactor * std::sqrt(expect.area_share * largest_face(part.core)));
    if (part.crown > 0)
      k.tilt = std::max(k.tilt, 4. / 3 * std::sqrt(part.radius * overlap) * overlap / part.crown);
  }
  return k;
}

// k of a shape's stiffest contact between two materials [N/m].
double normal_stiffness(const PairMaterial& pair, const ExpectedStiffness& expected, bool round) {
  return round && pair.stiffness > 0 ? pair.stiffness : pair.modulus * expected.normal;
}

}  // namespace

TimeStepLimit expected_limit(const Bodies& b, const ShapeTable& shapes, const PairMaterials& m,
                             const ContactExpectation& expect) {
  std::vector<ExpectedStiffness> stiffness(shapes.size());
  for (int s = 0; s < shapes.size(); ++s)
    stiffness[s] = expected_stiffness(shapes.shape(s), expect);
  TimeStepLimit worst = limit_of(-1, 0, 0);
  for (int i = 0; i < b.grains; ++i) {
    if (b.freedom[i] == kFixed) continue;
    const GrainShape& shape = shapes.shape(b.shape[i]);
    const ExpectedStiffness& expected = stiffness[b.shape[i]];
    const bool round = !shape.parts.empty();
    double stiffest = 0;  // k (1 + 2 kappa)/3
    double tilt = 0;
    for (int j = 0; j < m.materials(); ++j) {
      const PairMaterial& pair = m(b.material[i], j);
      double ratio =
          round ? std::max(pair.round_ratio, pair.tangential_ratio) : pair.tangential_ratio;
      if (!(pair.friction > 0)) ratio = 0;
      if (!(pair.modulus > 0)) continue;
      const double k = normal_stiffness(pair, expected, round);
      stiffest = std::max(stiffest, k * (1 + 2 * ratio) / 3);
      tilt = std::max(tilt, pair.modulus * expected.tilt);
    }
    const double r = shape.radius, least = b.inertia[i].minCoeff();
    const double omega2 =
        2 * expect.contacts * stiffest * (1 / b.mass[i] + r * r / (2 * least)) + 2 * tilt / least;
    if (omega2 > worst.omega * worst.omega)
      worst = limit_of(i, omega2, static_cast<int>(std::ceil(expect.contacts)));
  }
  return worst;
}

double rule_of_thumb(const std::string& rule, const Bodies& b, const ShapeTable& shapes,
                     const PairMaterials& m, const ContactExpectation& expect) {
  if (rule != "sun2015" && rule != "rayleigh")
    throw InputError("there is no time step rule '" + rule +
                     "'; the rules are 'sun2015', 'rayleigh'");
  double dt = HUGE_VAL, lightest = HUGE_VAL;
  for (int i = 0; i < b.grains; ++i) {
    if (b.freedom[i] == kFixed) continue;
    const GrainShape& shape = shapes.shape(b.shape[i]);
    const bool round = !shape.parts.empty();
    double modulus = 0, k = 0;
    const ExpectedStiffness expected = expected_stiffness(shape, expect);
    for (int j = 0; j < m.materials(); ++j) {
      const PairMaterial& pair = m(b.material[i], j);
      modulus = std::max(modulus, pair.modulus);
      if (pair.modulus > 0) k = std::max(k, normal_stiffness(pair, expected, round));
    }
    if (rule == "rayleigh") {
      constexpr double nu = 0.3;
      const double r = std::cbrt(0.75 * shape.volume / M_PI), rho = b.mass[i] / shape.volume;
      const double young = round ? 2 * (1 - nu * nu) * modulus : modulus;
      const double shear = young / (2 * (1 + nu));
      dt = std::min(dt, M_PI * r * std::sqrt(rho / shear) / (0.1631 * nu + 0.8766));
    } else if (b.mass[i] < lightest) {
      lightest = b.mass[i];
      dt = 2 * M_PI * std::sqrt(lightest / k) / 40;
    }
  }
  return dt;
}

TimeStepLimit measured_limit(const Bodies& b, const Pairs& pairs, int threads,
                             const FurtherContacts& further) {
  std::vector<double> omega2(b.size());
  std::vector<int> contacts(b.size());
#pragma omp parallel for schedule(dynamic, 32) num_threads(threads) if (threads > 1)
  for (int i = 0; i < b.size(); ++i)
    omega2[i] = b.freedom[i] == kFixed ? 0 : body_bound(b, pairs, further, i, contacts[i]);
  TimeStepLimit worst = limit_of(-1, 0, 0);
  for (int i = 0; i < b.size(); ++i)
    if (omega2[i] > worst.omega * worst.omega) worst = limit_of(i, omega2[i], contacts[i]);
  return worst;
}

}  // namespace trackbed::dem
