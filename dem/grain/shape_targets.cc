#include "dem/grain/shape_targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "base/error.h"
#include "dem/grading/shadow.h"
#include "dem/grain/shape_indices.h"
#include "dem/grain/voronoi.h"

namespace trackbed::dem {
namespace {

Vec3 extents(const Polyhedron& body) {
  Vec3 low = body.vertices.front(), high = low;
  for (const Vec3& v : body.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return high - low;
}

// Axes by extent, longest first.
std::array<int, 3> by_extent(const Polyhedron& body) {
  const Vec3 e = extents(body);
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return e[a] > e[b]; });
  return order;
}

// Factors of L, I, S, in the grain's principal frame: an affine map keeps faces flat.
void stretch(Polyhedron& body, double l, double i, double s) {
  const auto order = by_extent(body);
  for (Vec3& v : body.vertices) v[order[0]] *= l, v[order[1]] *= i, v[order[2]] *= s;
}

double mean(const std::vector<Polyhedron>& bodies,
            const std::function<double(const Polyhedron&)>& of) {
  double sum = 0;
  for (const Polyhedron& body : bodies) sum += of(body);
  return sum / double(bodies.size());
}

double sphericity(const Polyhedron& body) {
  double surface = 0;
  for (const Vec3& a : face_areas(body)) surface += a.norm();
  const double v = mass_properties(body).volume;
  return std::cbrt(36 * M_PI * v * v) / surface;
}

[[noreturn]] void out_of_reach(const char* what, double target, double low, double high) {
  char text[200];
  std::snprintf(text, sizeof text,
                "grain library: mean %s %.4g is out of reach; these shapes reach %.4g to %.4g",
                what, target, low, high);
  throw InputError(text);
}

// Stretches to elongation and flatness, or to sphericity.
void stretch_to(std::vector<Polyhedron>& bodies, const ShapeTargets& t) {
  if (t.elongation == 0 && t.flatness == 0 && t.sphericity == 0) return;
  for (Polyhedron& body : bodies) body = make_grain_shape(body).body;
  double i = 1, s = 1;
  if (t.sphericity == 0) {
    const auto ratio = [](int large, int small) {
      return [=](const Polyhedron& b) {
        const auto order = by_extent(b);
        return extents(b)[order[small]] / extents(b)[order[large]];
      };
    };
    if (t.elongation > 0) i = t.elongation / mean(bodies, ratio(0, 1));
    s = i * (t.flatness > 0 ? t.flatness / mean(bodies, ratio(1, 2)) : 1);
  } else {
    const auto with = [&](double k) {
      return mean(bodies, [&](const Polyhedron& b) {
        Polyhedron copy = b;
        stretch(copy, 1, k, k * k);
        return sphericity(copy);
      });
    };
    double small = 0.1, large = 1;
    const double least = with(small), most = with(large);
    if (!(t.sphericity >= least && t.sphericity <= most + 1e-9))
      out_of_reach("sphericity", t.sphericity, least, most);
    for (int step = 0; step < 30; ++step) {
      const double k = 0.5 * (small + large);
      (with(k) < t.sphericity ? small : large) = k;
    }
    i = large, s = large * large;
  }
  for (Polyhedron& body : bodies) stretch(body, 1, i, s);
}

std::vector<Polyhedron> shaped(const std::vector<Polyhedron>& bodies, double share,
                               const ShapeTargets& t) {
  std::vector<Polyhedron> result(bodies.size());
#pragma omp parallel for schedule(dynamic, 4)
  for (int k = 0; k < int(bodies.size()); ++k) result[k] = blunted(bodies[k], share);
  stretch_to(result, t);
  return result;
}

void check(const ShapeTargets& t) {
  for (double ratio : {t.elongation, t.flatness})
    if (!(ratio >= 0 && ratio <= 1))
      throw InputError("grain library: elongation and flatness must lie in (0, 1], or be 0");
  if (!(t.sphericity >= 0 && t.sphericity < 1))
    throw InputError("grain library: sphericity must lie in (0, 1), or be 0");
  if (!(t.angularity >= 0) || !std::isfinite(t.angularity))
    throw InputError("grain library: angularity must be positive, or 0");
  if (t.sphericity > 0 && (t.elongation > 0 || t.flatness > 0))
    throw InputError(
        "grain library: sphericity cannot be given together with elongation or flatness");
}

// Stretches or presses one axis until `done`.
Polyhedron until(const Polyhedron& given, double l, double s,
                 const std::function<bool(const ShapeIndices&, double sieve)>& done,
                 SieveMethod method) {
  Polyhedron body = make_grain_shape(given).body;
  for (int step = 0; step < 200; ++step) {
    if (done(shape_indices(body), sieve_size(body, method))) return body;
    stretch(body, l, 1, s);
  }
  throw InputError("grain library: a grain could not be made a needle or a flake");
}

}  // namespace

Polyhedron blunted(const Polyhedron& body, double share, double depth) {
  const Vec3 centre = mass_properties(body).centroid;
  std::map<std::pair<int, int>, int> owner;
  for (int f = 0; f < int(body.faces.size()); ++f) {
    const auto& face = body.faces[f];
    for (size_t k = 0; k < face.size(); ++k) owner[{face[k], face[(k + 1) % face.size()]}] = f;
  }
  std::vector<Vec3> normals;
  std::vector<double> offsets;
  const std::vector<Vec3> areas = face_areas(body);
  for (size_t f = 0; f < areas.size(); ++f) {
    normals.push_back(areas[f].normalized());
    offsets.push_back(normals[f].dot(body.vertices[body.faces[f][0]] - centre));
  }
  struct Cut {
    double cosine;  // of the angle the faces make
    Vec3 normal;
    double offset;
  };
  std::vector<Cut> cuts;
  for (const auto& [edge, f] : owner) {
    if (edge.first > edge.second) continue;
    const Vec3 &a = normals[f], &b = normals[owner.at({edge.second, edge.first})];
    const Vec3 m = (a + b).normalized();
    cuts.push_back({a.dot(b), m, (1 - depth) * m.dot(body.vertices[edge.first] - centre)});
  }
  std::stable_sort(cuts.begin(), cuts.end(),
                   [](const Cut& a, const Cut& b) { return a.cosine < b.cosine; });
  cuts.resize(size_t(std::lround(share * double(cuts.size()))));
  if (cuts.empty()) return body;
  for (const Cut& c : cuts) normals.push_back(c.normal), offsets.push_back(c.offset);
  return intersect_half_spaces(normals, offsets);
}

std::vector<Polyhedron> reach_targets(std::vector<Polyhedron> bodies, const ShapeTargets& t) {
  check(t);
  if (t.angularity == 0) {
    stretch_to(bodies, t);
    return bodies;
  }
  // The share of edges is sought on some of the shapes.
  const std::vector<Polyhedron> some(bodies.begin(),
                                     bodies.begin() + std::min<size_t>(100, bodies.size()));
  const auto with = [&](double share) { return mean(shaped(some, share, t), angularity); };
  double few = 0, many = 1;
  const double most = with(few), least = with(many);
  if (!(t.angularity >= least && t.angularity <= most))
    out_of_reach("angularity", t.angularity, least, most);
  for (int step = 0; step < 10; ++step) {
    const double share = 0.5 * (few + many);
    (with(share) > t.angularity ? few : many) = share;
  }
  return shaped(bodies, 0.5 * (few + many), t);
}

Polyhedron as_needle(const Polyhedron& body, SieveMethod method) {
  return until(
      body, 1.05, 1, [](const ShapeIndices& s, double d) { return s.diameter > 1.89 * d; }, method);
}

Polyhedron as_flake(const Polyhedron& body, SieveMethod method) {
  return until(
      body, 1, 0.95, [](const ShapeIndices& s, double d) { return s.width < 0.57 * d; }, method);
}

}  // namespace trackbed::dem
