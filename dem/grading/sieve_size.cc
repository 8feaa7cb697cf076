#include "dem/grading/sieve_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "dem/grading/shadow.h"
#include "dem/grain/nearest_name.h"

namespace trackbed::dem {
namespace {

// The least over directions of least shadow area of `size(shadow)`: directions whose areas differ
// by rounding only count as equal, so that a symmetric grain's size does not hang on its pose.
template <class Size>
double at_least_shadow(const Polyhedron& body, const std::vector<Vec3>& directions, Size size) {
  const std::vector<Vec3> areas = face_areas(body);
  std::vector<double> area;
  for (const Vec3& u : directions) area.push_back(shadow_area(areas, u));
  if (area.empty()) throw InputError("sieve size: the grain has no edges");
  const double least = *std::min_element(area.begin(), area.end());
  double best = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < directions.size(); ++k)
    if (area[k] <= least * (1 + 1e-9)) best = std::min(best, size(shadow(body, directions[k])));
  return best;
}

std::vector<Vec3> edge_directions(const Polyhedron& body) {
  std::vector<Vec3> directions;
  for (const auto& face : body.faces)
    for (size_t k = 0; k < face.size(); ++k) {
      const int a = face[k], b = face[(k + 1) % face.size()];
      const Vec3 e = body.vertices[b] - body.vertices[a];
      if (a < b && e.norm() > 0) directions.push_back(e.normalized());
    }
  return directions;
}

std::vector<Vec3> normal_cross_directions(const Polyhedron& body) {
  std::vector<Vec3> normals, directions;
  for (const Vec3& a : face_areas(body))
    if (a.norm() > 0) normals.push_back(a.normalized());
  for (size_t i = 0; i < normals.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Vec3 d = normals[i].cross(normals[j]);
      if (d.norm() > 1e-9) directions.push_back(d.normalized());
    }
  return directions;
}

double shao_square(const std::vector<Vec2>& polygon) {
  const Rectangle r = least_rectangle(polygon);
  return std::min(r.p, (r.p + r.q) / std::sqrt(2.0));
}

}  // namespace

const std::vector<std::string>& sieve_method_names() {
  static const std::vector<std::string> names = {"equal_cube", "equal_sphere", "elias2014",
                                                 "shao2017",   "min_shadow",   "exact"};
  return names;
}

std::string to_string(SieveMethod method) { return sieve_method_names()[static_cast<int>(method)]; }

SieveMethod parse_sieve_method(const std::string& name) {
  const auto& names = sieve_method_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw InputError(unknown_name("sieve method", name, names));
  return static_cast<SieveMethod>(found - names.begin());
}

double sieve_size(const Polyhedron& body, SieveMethod method) {
  const double volume = mass_properties(body).volume;
  switch (method) {
    case SieveMethod::equal_cube:
      return std::cbrt(volume);
    case SieveMethod::equal_sphere:
      return std::cbrt(6 * volume / M_PI);
    case SieveMethod::elias2014:
      return least_flush_square(shadow(make_grain_shape(body).body, Vec3::UnitX()));
    case SieveMethod::shao2017:
      return at_least_shadow(body, edge_directions(body), shao_square);
    case SieveMethod::min_shadow:
      return at_least_shadow(body, normal_cross_directions(body), least_square);
    case SieveMethod::exact:
      return exact_sieve_size(body).size;
  }
  throw InputError("sieve size: unknown method");
}

}  // namespace trackbed::dem
