#include "fem/bed_integrals.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/supports.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// The bed with the springs and dashpots of an absorbing boundary on this material.
Bed absorbing(Bed bed, const std::array<double, 3>& elastic) {
  if (!bed.absorbing) return bed;
  const auto [young, poisson, density] = elastic;
  const double shear = young / (2 * (1 + poisson));
  const double confined = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
  bed.normal_dashpot += std::sqrt(density * confined);
  bed.shear_dashpot += std::sqrt(density * shear);
  if (bed.distance > 0) {
    bed.normal_stiffness += 4. / 3 * shear / bed.distance;
    bed.shear_stiffness += 2. / 3 * shear / bed.distance;
  }
  return bed;
}

}  // namespace

FaceSprings face_springs(const Bed& given, const Discretisation& body, const Face& face,
                         const std::array<double, 3>& elastic) {
  const Bed bed = absorbing(given, elastic);
  const int n = 3 * face.count;
  FaceSprings springs{std::vector<double>(n * n), std::vector<double>(n * n)};
  for (const FacePoint& point : face_points(body, face))
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        const double normal = point.normal[a % 3] * point.normal[b % 3];
        const double shear = (a % 3 == b % 3) - normal;
        const double w = point.shape[a / 3] * point.shape[b / 3] * point.area;
        springs.stiffness[n * a + b] +=
            w * (bed.normal_stiffness * normal + bed.shear_stiffness * shear);
        springs.dashpot[n * a + b] += w * (bed.normal_dashpot * normal + bed.shear_dashpot * shear);
      }
  return springs;
}

int check_bed(const ElasticBodyParameters& p, const Bed& bed, const Discretisation& body) {
  const int id = find_boundary(body, p.name, "bed", bed.boundary);
  for (const double value : {bed.normal_stiffness, bed.shear_stiffness, bed.normal_dashpot,
                             bed.shear_dashpot, bed.distance})
    if (!(value >= 0))
      throw InputError(
          text(p.name, ": bed on '", bed.boundary, "': ", value, ", must be 0 or more"));
  return id;
}

bool has_dashpots(const ElasticBodyParameters& p) {
  return std::any_of(p.beds.begin(), p.beds.end(), [](const Bed& b) { return b.has_dashpots(); });
}

bool damps(const ElasticBodyParameters& p) {
  bool any = has_dashpots(p);
  for (const Material& m : p.materials) any |= m.rayleigh_mass > 0 || m.rayleigh_stiffness > 0;
  return any;
}

}  // namespace trackbed::fem
