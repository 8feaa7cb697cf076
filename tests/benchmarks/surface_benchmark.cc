// Time of one evaluation per touching grain on a patch, for meshes coarser and finer than grains,
// and of a search. Prints, asserts nothing.
#include <chrono>
#include <cstdio>

#include "base/prepare_process.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "surface_scene.h"

using namespace trackbed::dem;

namespace {

template <class F>
double seconds(int times, F&& f) {
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < times; ++k) f();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / times;
}

}  // namespace

int main(int, char** argv) {
  trackbed::prepare_process(argv);
  VoronoiParameters parameters;
  parameters.count = 100;
  const auto grains = voronoi_grains(parameters);
  std::printf("elements a grain   facets a contact  evaluation us/grain   search us/grain\n");
  for (const double per_grain : {.25, .5, 1., 2., 4., 8.}) {
    const int n = static_cast<int>(15 * per_grain);
    PatchScene s(flat_mesh(n, n, -7.5, 7.5, -7.5, 7.5), .1, 1, 1e7, .5);
    Random random(1);
    for (int k = 0; k < 100; ++k) {
      const Quat q(Eigen::AngleAxisd(random.uniform(0, 6), random.direction()));
      s.add(grains[k], 1000, {-6.5 + 1.4 * (k % 10), -6.5 + 1.4 * (k / 10), 0}, q);
      double low = HUGE_VAL;
      const ConvexView v = s.shapes.view(k);
      for (int j = 0; j < v.vertices; ++j)
        low = std::min(low, (s.bodies.R[k] * Vec3(v.x[j], v.y[j], v.z[j])).z());
      s.bodies.x[k].z() = -low - .005;
    }
    s.skin = .05;
    s.evaluate_afresh();
    const int touching = count_contacts(s.contacts);
    const double evaluation = seconds(200, [&] { s.evaluate(1e-6); });
    const double search = seconds(
        5, [&] { search_patch(s.bodies, s.shapes, s.patch, s.context, s.skin, s.contacts); });
    std::printf("%16.2f %17.1f %21.3f %17.2f\n", per_grain,
                double(s.contacts.triangle.size()) / s.contacts.size(), 1e6 * evaluation / touching,
                1e6 * search / 100);
  }
}
