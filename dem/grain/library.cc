#include "dem/grain/library.h"

#include <exception>

#include "base/error.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/jin.h"
#include "dem/grain/nearest_name.h"
#include "dem/grain/off_io.h"
#include "dem/grain/shape_targets.h"
#include "dem/grain/voronoi.h"

namespace trackbed::dem {
namespace {

JinStonesParameters stones_of(const LibraryParameters& p) {
  JinStonesParameters j;
  j.count = p.count, j.seed = p.seed;
  j.length_over_height = {p.length_over_height, p.length_over_height_deviation};
  j.divisions = p.divisions, j.least_scale = p.least_scale, j.largest_scale = p.largest_scale;
  return j;
}

std::vector<Polyhedron> generate(const LibraryParameters& p) {
  if (p.count < 1) throw InputError("grain library: count must be at least 1");
  if (p.generator == "voronoi") return voronoi_grains({p.count, p.seed, p.spacing, p.least_face});
  if (p.generator == "ellipsoid") {
    EllipsoidParameters e;
    e.count = p.count, e.seed = p.seed, e.axes = p.axes;
    e.points_least = p.points_least, e.points_most = p.points_most;
    return ellipsoid_grains(e);
  }
  if (p.generator == "jin_hull") {
    std::vector<Polyhedron> hulls;
    for (const TriangleSolid& stone : jin_stones(stones_of(p)))
      hulls.push_back(convex_hull(stone.vertices));
    return hulls;
  }
  if (p.generator == "files") {
    std::vector<Polyhedron> stones;
    for (const std::string& file : p.files)
      for (Polyhedron& stone : read_solids(file, {1, p.hull})) stones.push_back(std::move(stone));
    if (stones.empty()) throw InputError("grain library: no files of stones are given");
    return stones;
  }
  throw InputError(unknown_name("grain generator", p.generator, generator_names()));
}

// Runs over 0 … n-1 on all threads; tells progress; the failure of least i is thrown at the end.
void in_parallel(int n, const std::function<void(double)>& progress,
                 const std::function<void(int)>& work) {
  std::exception_ptr failure;
  int failed = n;
  int done = 0;
#pragma omp parallel for schedule(dynamic, 4)
  for (int i = 0; i < n; ++i) {
    try {
      work(i);
    } catch (...) {
#pragma omp critical(library_failure)
      if (i < failed) failed = i, failure = std::current_exception();
    }
    if (progress) {
#pragma omp critical(library_progress)
      progress(double(++done) / n);
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

const std::vector<std::string>& generator_names() {
  static const std::vector<std::string> names = {"voronoi", "ellipsoid", "jin_hull", "files"};
  return names;
}

std::vector<GrainShape> size_grains(const std::vector<Polyhedron>& bodies, SieveMethod method,
                                    const std::function<void(double)>& progress) {
  std::vector<GrainShape> shapes(bodies.size());
  in_parallel(int(bodies.size()), progress, [&](int i) {
    shapes[i] = make_grain_shape(bodies[i]);
    shapes[i].sieve_size = sieve_size(shapes[i].body, method);
  });
  return shapes;
}

std::vector<GrainShape> make_library(const LibraryParameters& p,
                                     const std::function<void(double)>& progress) {
  std::vector<Polyhedron> bodies = generate(p);
  const int count = static_cast<int>(bodies.size());
  if (p.needles < 0 || p.flakes < 0 || p.needles + p.flakes > count)
    throw InputError("grain library: needles and flakes must be at most count together");
  bodies = reach_targets(std::move(bodies), {p.elongation, p.flatness, p.sphericity, p.angularity});
  std::vector<GrainShape> shapes(bodies.size());
  in_parallel(count, progress, [&](int i) {
    Polyhedron body = bodies[i];
    if (i < p.needles)
      body = as_needle(body, p.method);
    else if (i < p.needles + p.flakes)
      body = as_flake(body, p.method);
    const GrainShape own = make_grain_shape(body);
    shapes[i] = scaled(own, 1 / sieve_size(own.body, p.method));
    shapes[i].sieve_size = 1;
  });
  return shapes;
}

std::vector<ClumpShape> make_clump_library(const LibraryParameters& p, double least_radius,
                                           double space_factor,
                                           const std::function<void(double)>& progress) {
  const std::vector<TriangleSolid> stones = jin_stones(stones_of(p));
  std::vector<ClumpShape> shapes(stones.size());
  in_parallel(int(stones.size()), progress, [&](int i) {
    FillingParameters filling;  // the stones have W = 1 m
    filling.least_radius = least_radius, filling.space_factor = space_factor;
    filling.seed = p.seed + i;
    filling.at_least_one = true;
    const ClumpShape own = make_clump_shape(fill_with_spheres(stones[i], filling));
    shapes[i] = scaled(own, 1 / sieve_size(own.spheres, p.method));
    shapes[i].sieve_size = 1;
  });
  return shapes;
}

}  // namespace trackbed::dem
