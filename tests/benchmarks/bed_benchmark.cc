// Growth and effects on a settled, periodic bed.
//   bed_benchmark growth [folder or ""] [tiles (10)] [polyhedra|spheres] [grains (1000)]
//       step per grain and memory per grain, from 1 to tiles^2 copies of the bed; the exponent of
//       time in grains. Copies lie one after the other: grains are ordered in space by copies.
//   bed_benchmark effects [folder or ""] [rounds (12)] [grains (1000)]
//       each effect switched on or off, as a ratio to the bed with friction and local damping, in
//       turn so that a machine whose speed drifts treats all alike
// Beds of polyhedra are kept in the folder.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/prepare_process.h"
#include "in_turn.h"
#include "settled_bed.h"

using namespace trackbed::dem;

namespace {

double memory() {  // allocated now [B]
  const auto info = mallinfo2();
  return double(info.uordblks) + double(info.hblkhd);
}

struct Copies {
  Scene scene;
  double bytes = 0;
  std::vector<double> seconds;
};

void growth(const Scene& bed, int most) {
  std::vector<Copies> beds;
  std::vector<int> copies{1};
  if (most > 3) copies.push_back(3);
  if (most > 1) copies.push_back(most);
  for (const int tiles : copies) {
    const double before = memory();
    beds.push_back({tiled(bed, tiles, tiles), 0, {}});
    Scene& s = beds.back().scene;
    s.step();
    s.candidates.rebuild(s.bodies, s.shapes, s.context, s.pairs);  // as a bed in motion searches
    beds.back().bytes = memory() - before;
  }
  constexpr int kRounds = 7;
  const int last = static_cast<int>(beds.size()) - 1;
  std::vector<double> exponents;
  for (int round = 0; round < kRounds; ++round) {
    for (int k = 0; k <= last; ++k)
      beds[k].seconds.push_back(median_step(beds[k].scene, k == last ? 9 : 41));
    exponents.push_back(std::log(beds[last].seconds.back() / beds[0].seconds.back()) /
                        std::log(double(beds[last].scene.bodies.grains) / bed.bodies.grains));
  }
  std::printf("| grains | touching pairs | us per touching pair | us per grain | kB per grain |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const Copies& c : beds) {
    const double seconds = median(c.seconds), grains = c.scene.bodies.grains;
    const int touching = count_contacts(c.scene.pairs);
    std::printf("| %.0f | %d | %.3f | %.3f | %.1f |\n", grains, touching, 1e6 * seconds / touching,
                1e6 * seconds / grains, c.bytes / 1e3 / grains);
  }
  std::printf(
      "exponent of time per step in grains: %.3f (median of %d rounds in turn; %.3f to %.3f)\n",
      median(exponents), kRounds, *std::min_element(exponents.begin(), exponents.end()),
      *std::max_element(exponents.begin(), exponents.end()));
}

struct Variant {
  const char* name;
  Scene scene;
  std::vector<double> seconds;
};

void effects(const Scene& bed, int rounds) {
  std::vector<Variant> variants{{"friction and local damping", bed, {}}};
  const auto add = [&](const char* name, auto change) {
    variants.push_back({name, bed, {}});
    change(variants.back().scene);
  };
  add("without friction", [](Scene& s) { s.forces = make_pair_forces("stored_energy", false); });
  add("without damping", [](Scene& s) { s.context.local_damping = 0; });
  add("adaptive damping instead", [](Scene& s) { s.context.local_damping = 0, s.adaptive = true; });
  add("with torsional friction", [](Scene& s) { s.resistance.torsion = 1; });
  add("with rolling resistance", [](Scene& s) { s.resistance.rolling = .1; });
  add("shao2017's law", [](Scene& s) { s.forces = make_pair_forces("shao2017", true); });
  add("not periodic", [](Scene& s) { s.context.period = Vec3::Zero(), s.prepare(); });
  for (int round = 0; round < rounds; ++round)
    for (Variant& v : variants)
      v.seconds.push_back(median_step(v.scene, 9) / count_contacts(v.scene.pairs));
  double base = 0;
  std::printf("| bed | us per touching pair and step | ratio |\n|---|---|---|\n");
  for (Variant& v : variants) {
    std::sort(v.seconds.begin(), v.seconds.end());
    const double seconds = v.seconds[v.seconds.size() / 2];
    if (base == 0) base = seconds;
    std::printf("| %s | %.3f | %.2f |\n", v.name, 1e6 * seconds, seconds / base);
  }
}

}  // namespace

int main(int argc, char** argv) {
  trackbed::prepare_process(argv);
  const std::string what = argc > 1 ? argv[1] : "";
  if (what != "growth" && what != "effects") {
    std::fprintf(stderr,
                 "bed_benchmark growth|effects [folder] ...: see the head of bed_benchmark.cc\n");
    return 2;
  }
  BedSettings settings;
  const auto argument = [&](int k, const char* otherwise) -> std::string {
    return argc > k ? argv[k] : otherwise;
  };
  settings.folder = argument(2, "");
  const bool grows = what == "growth";
  settings.spheres = grows && argument(4, "polyhedra") == "spheres";
  settings.grains = std::stoi(argument(grows ? 5 : 4, "1000"));
  const Scene bed = settled_bed(settings);
  if (grows)
    growth(bed, std::stoi(argument(3, "10")));
  else
    effects(bed, std::stoi(argument(3, "12")));
}
