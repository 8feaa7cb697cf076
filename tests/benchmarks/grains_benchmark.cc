// How long making and sizing grains takes: exact sizes of 1000 grains of 15 faces on one core, and
// libraries of Voronoi grains of growing size on two. Processor time is given beside wall time:
// on a busy machine only the former is repeatable.
// usage: grains_benchmark [LARGEST LIBRARY = 10000]
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "dem/grading/draw.h"
#include "dem/grain/library.h"
#include "dem/grain/voronoi.h"

namespace {

using namespace trackbed::dem;

struct Clock {
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
  std::clock_t cpu = std::clock();  // of all threads
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  }
  double cpu_seconds() const { return double(std::clock() - cpu) / CLOCKS_PER_SEC; }
};

void exact_sizes() {
  VoronoiParameters p;
  p.count = 9000;
  std::vector<Polyhedron> bodies;
  for (const Polyhedron& body : voronoi_grains(p))
    if (body.faces.size() == 15 && bodies.size() < 1000) bodies.push_back(body);
  const Clock clock;
  for (const Polyhedron& body : bodies) exact_sieve_size(body);
  std::printf("exact size of %zu Voronoi grains of 15 faces, one core: %.2f s, processor %.2f s\n",
              bodies.size(), clock.seconds(), clock.cpu_seconds());
}

void library(int count) {
  LibraryParameters p;
  p.count = count;
  const Clock generating;
  voronoi_grains({count, p.seed, p.spacing, p.least_face});
  const double generated = generating.cpu_seconds();
  const Clock clock;
  const std::vector<GrainShape> shapes = make_library(p);
  const double cpu = clock.cpu_seconds();
  std::printf(
      "library of %6d Voronoi grains, exact sizes, two cores: %6.1f s; processor %6.1f s, "
      "%.2f ms a grain, %.2f of it making the cells\n",
      count, clock.seconds(), cpu, 1e3 * cpu / count, 1e3 * generated / count);
  const Clock drawing;
  DrawParameters d;
  d.volume = 0.6 * 0.3 * 0.35 / 1.5;
  const auto grains = draw_gradation(named_curve("shao2017_wide"), shapes, d).grains.size();
  std::printf("  draw of %zu grains from it: %.3f s\n", grains, drawing.cpu_seconds());
}

}  // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::max(8, std::atoi(argv[1])) : 10000;
  omp_set_num_threads(1);
  exact_sizes();
  omp_set_num_threads(2);
  for (int count = largest / 8; count <= largest; count *= 2) library(count);
}
