// Shao, Lian, Yang 2017: the paper's three gradations, drawn from Voronoi grains for its box of
// 0.6 x 0.3 x 0.35 m at 1.72 g/cm3 (grains 2.6 g/cm3).
// usage: gradations_study FOLDER [SHAPES] [SEEDS]; writes FOLDER/gradations.csv and classes.csv
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "dem/grading/draw.h"
#include "dem/grain/library.h"

namespace {

using namespace trackbed::dem;

void write(const std::string& folder, int shapes, int seeds) {
  LibraryParameters lp;
  lp.count = shapes;
  const auto library = make_library(lp);
  std::filesystem::create_directories(folder);
  std::ofstream curves(folder + "/gradations.csv"), classes(folder + "/classes.csv");
  curves << "gradation,seed,grains,mass_kg,sieve_m,target_percent,achieved_percent\n";
  classes << "gradation,seed,low_m,high_m,target_volume_m3,achieved_volume_m3,grains\n";
  for (const char* name : {"shao2017_large", "shao2017_small", "shao2017_wide"}) {
    const SieveCurve curve = named_curve(name);
    for (int seed = 1; seed <= seeds; ++seed) {
      DrawParameters p;
      p.volume = solid_volume(0.6 * 0.3 * 0.35, 1720, 2600);
      p.seed = seed;
      const GradationDraw d = draw_gradation(curve, library, p);
      double worst = 0;
      for (size_t i = 0; i < curve.sieve.size(); ++i) {
        worst = std::max(worst, std::abs(d.achieved_passing[i] - curve.passing[i]));
        curves << name << ',' << seed << ',' << d.grains.size() << ',' << 2600 * d.volume << ','
               << curve.sieve[i] << ',' << curve.passing[i] << ',' << d.achieved_passing[i] << '\n';
      }
      for (const DrawnClass& c : d.classes)
        classes << name << ',' << seed << ',' << c.low << ',' << c.high << ',' << c.target_volume
                << ',' << c.achieved_volume << ',' << c.count << '\n';
      std::printf("%s seed %d: %zu grains, %.2f kg, largest deviation %.3g %%\n", name, seed,
                  d.grains.size(), 2600 * d.volume, worst);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: gradations_study FOLDER [SHAPES] [SEEDS]\n");
    return 2;
  }
  try {
    write(argv[1], argc > 2 ? std::atoi(argv[2]) : 500, argc > 3 ? std::atoi(argv[3]) : 5);
  } catch (const trackbed::InputError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
