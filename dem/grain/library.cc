#include "dem/grain/library.h"

#include <algorithm>
#include <exception>

#include "base/error.h"
#include "dem/grain/nearest_name.h"
#include "dem/grain/voronoi.h"

namespace trackbed::dem {
namespace {

std::vector<Polyhedron> generate(const LibraryParameters& p) {
  if (p.count < 1) throw InputError("grain library: count must be at least 1");
  if (p.generator == "voronoi") return voronoi_grains({p.count, p.seed, p.spacing, p.least_face});
  if (p.generator == "ellipsoid") {
    EllipsoidParameters e;
    e.count = p.count;
    e.seed = p.seed;
    return ellipsoid_grains(e);
  }
  throw InputError(unknown_name("grain generator", p.generator, generator_names()));
}

// Extents along the principal axes, longest first.
Vec3 principal_extents(const Polyhedron& body) {
  Vec3 low = body.vertices.front(), high = low;
  for (const Vec3& v : body.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return high - low;
}

void stretch(std::vector<Polyhedron>& bodies, double elongation, double flatness) {
  if (elongation == 0 && flatness == 0) return;
  for (double ratio : {elongation, flatness})
    if (!(ratio >= 0 && ratio <= 1))
      throw InputError("grain library: elongation and flatness must lie in (0, 1], or be 0");
  double mean_elongation = 0, mean_flatness = 0;
  for (Polyhedron& body : bodies) {
    body = make_grain_shape(body).body;
    Vec3 e = principal_extents(body);
    std::sort(e.data(), e.data() + 3);
    mean_elongation += e[1] / e[2] / double(bodies.size());
    mean_flatness += e[0] / e[1] / double(bodies.size());
  }
  const double i = elongation > 0 ? elongation / mean_elongation : 1;
  const double s = i * (flatness > 0 ? flatness / mean_flatness : 1);
  for (Polyhedron& body : bodies) {  // an affine map keeps a convex body convex, its faces flat
    const Vec3 e = principal_extents(body);
    int order[3] = {0, 1, 2};
    std::sort(order, order + 3, [&](int a, int b) { return e[a] > e[b]; });
    for (Vec3& v : body.vertices) v[order[1]] *= i, v[order[2]] *= s;
  }
}

}  // namespace

const std::vector<std::string>& generator_names() {
  static const std::vector<std::string> names = {"voronoi", "ellipsoid"};
  return names;
}

std::vector<GrainShape> size_grains(const std::vector<Polyhedron>& bodies, SieveMethod method,
                                    const std::function<void(double)>& progress) {
  const int n = static_cast<int>(bodies.size());
  std::vector<GrainShape> shapes(n);
  std::exception_ptr failure;
  int done = 0;
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < n; ++i) {
    try {
      shapes[i] = make_grain_shape(bodies[i]);
      shapes[i].sieve_size = sieve_size(shapes[i].body, method);
    } catch (...) {
#pragma omp critical
      failure = std::current_exception();
    }
    if (progress) {
#pragma omp critical
      progress(double(++done) / n);
    }
  }
  if (failure) std::rethrow_exception(failure);
  return shapes;
}

std::vector<GrainShape> make_library(const LibraryParameters& p,
                                     const std::function<void(double)>& progress) {
  std::vector<Polyhedron> bodies = generate(p);
  stretch(bodies, p.elongation, p.flatness);
  std::vector<GrainShape> shapes = size_grains(bodies, p.method, progress);
  for (GrainShape& shape : shapes) {
    shape = scaled(shape, 1 / shape.sieve_size);
    shape.sieve_size = 1;
  }
  return shapes;
}

}  // namespace trackbed::dem
