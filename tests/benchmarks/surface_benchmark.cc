// Grains of each shape lying on a deforming surface, for meshes coarser and finer than they are: one
// evaluation per touching grain on one thread, the gain of a second, and a search. Prints, asserts
// nothing.
#include <chrono>
#include <cstdio>

#include "base/prepare_process.h"
#include "dem/contact/part_pairs.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "dem/surface/round_patch.h"
#include "in_turn.h"
#include "surface_scene.h"

using namespace trackbed::dem;

namespace {

constexpr int kRow = 20;         // grains along a side
constexpr double kPitch = 1.4;   // of their centres; they are about 1 wide
constexpr double kDepth = .005;  // of each in the surface

struct Kind {
  const char* name;
  std::vector<GrainShape> shapes;
  const char* law;
};

std::vector<Kind> kinds() {
  VoronoiParameters parameters;
  parameters.count = 100;
  std::vector<GrainShape> plain, dilated;
  for (const Polyhedron& p : voronoi_grains(parameters)) {
    plain.push_back(make_grain_shape(p));
    DilatedPolyhedron body{plain.back().body, .04};
    for (Vec3& v : body.core.vertices) v *= 1 - .04 / plain.back().radius;
    dilated.push_back(as_grain(make_dilated_shape(body)));
  }
  return {{"polyhedra", plain, "stored_energy"},
          {"dilated polyhedra", dilated, "hertz_mindlin"},
          {"dilated polyhedra, flat faces", dilated, "hertz_flat"},
          {"spheres", {sphere_shape(.5)}, "hertz_mindlin"}};
}

void lay(PatchScene& s, const std::vector<GrainShape>& shapes) {
  Random random(1);
  for (int k = 0; k < kRow * kRow; ++k) {
    const Quat q(Eigen::AngleAxisd(random.uniform(0, 6), random.direction()));
    const Vec3 at(kPitch * (k % kRow + .5 - .5 * kRow), kPitch * (k / kRow + .5 - .5 * kRow), 0);
    const int shape = s.shapes.add(shapes[k % shapes.size()]);
    const int i = add_grain(s.bodies, s.shapes, shape, 0, 1000, at, q);
    s.travel.push_back(0);
    Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
    include_part(s.shapes.part(shape, 0), s.bodies.R[i], low, high);
    s.bodies.x[i].z() = -low.z() - kDepth;
  }
}

double seconds_each(int times, const std::function<void()>& f) {
  const double start = seconds_of(CLOCK_MONOTONIC);
  for (int k = 0; k < times; ++k) f();
  return (seconds_of(CLOCK_MONOTONIC) - start) / times;
}

/// The time that a tenth of the runs stay below [s], on so many threads.
double fast(PatchScene& s, int threads) {
  s.context.threads = threads;
  std::vector<double> seconds;
  for (int k = 0; k < 60; ++k) seconds.push_back(seconds_each(5, [&] { s.evaluate(1e-6); }));
  std::nth_element(seconds.begin(), seconds.begin() + 6, seconds.end());
  return seconds[6];
}

}  // namespace

int main(int, char** argv) {
  trackbed::prepare_process(argv);
  std::printf(
      "| grains | elements a grain | facets a contact | evaluation us/grain | "
      "2 threads: times as fast | search us/grain |\n|---|---|---|---|---|---|\n");
  for (const Kind& kind : kinds())
    for (const double per_grain : {.25, .5, 1., 2., 4., 8.}) {
      const int n = static_cast<int>(2 * kRow * per_grain);
      const double half = kRow * kPitch / 2 + .5;
      PatchScene s(flat_mesh(n, n, -half, half, -half, half), .1, 1, 1e7, .5);
      if (kind.law != std::string("stored_energy")) s.law = make_round_patch_forces(kind.law, true);
      lay(s, kind.shapes);
      s.skin = .05;
      s.evaluate_afresh();
      const int touching = count_contacts(s.contacts);
      const double one = fast(s, 1), two = fast(s, 2);
      const double search = seconds_each(
          5, [&] { search_patch(s.bodies, s.shapes, s.patch, s.context, s.skin, s.contacts); });
      std::printf("| %s | %.2f | %.1f | %.3f | %.2f | %.2f |\n", kind.name,
                  n * 1.0 / (kRow * kPitch), double(s.contacts.triangle.size()) / s.contacts.size(),
                  1e6 * one / touching, one / two, 1e6 * search / s.bodies.grains);
    }
}
