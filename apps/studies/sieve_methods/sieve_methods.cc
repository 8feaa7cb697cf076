// How the sieve methods misclassify against the exact size, and what each costs: Voronoi grains of
// exact sizes spread evenly (in the logarithm) over 16 to 80 mm, classes between Shao's sieves.
// usage: sieve_methods_study FOLDER [GRAINS] [SEED] [SPACING]; writes FOLDER/methods.csv and
// grains.csv
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "dem/grading/curve.h"
#include "dem/grading/sieve_size.h"
#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"

namespace {

using namespace trackbed::dem;

const std::vector<double> sieves = {0.016, 0.025, 0.0355, 0.045, 0.056, 0.063, 0.08};

int class_of(double size) {
  return int(std::lower_bound(sieves.begin(), sieves.end(), size) - sieves.begin());
}

struct Sizes {
  std::vector<double> ratio;  // size over exact size
  double seconds = 0;         // per grain
};

Sizes measure(const std::vector<Polyhedron>& grains, SieveMethod method) {
  Sizes s;
  int rounds = 0;
  const std::clock_t start = std::clock();  // processor time: other programs do not count
  double elapsed = 0;
  do {  // the cheap methods several times, so that the clock sees them
    s.ratio.clear();
    for (const Polyhedron& grain : grains) s.ratio.push_back(sieve_size(grain, method));
    ++rounds;
    elapsed = double(std::clock() - start) / CLOCKS_PER_SEC;
  } while (elapsed < 0.5);
  s.seconds = elapsed / (rounds * double(grains.size()));
  return s;
}

void write(const std::string& folder, int count, int seed, double spacing) {
  VoronoiParameters p;
  p.count = count;
  p.seed = seed;
  p.spacing = spacing;
  std::vector<Polyhedron> grains = voronoi_grains(p);
  std::vector<Sizes> all;
  for (const std::string& name : sieve_method_names())
    all.push_back(measure(grains, parse_sieve_method(name)));
  const std::vector<double> exact = all.back().ratio;
  Random random(seed);
  std::vector<double> size;
  for (int k = 0; k < count; ++k)
    size.push_back(sieves.front() * std::pow(sieves.back() / sieves.front(), random.uniform()));

  std::filesystem::create_directories(folder);
  std::ofstream methods(folder + "/methods.csv"), each(folder + "/grains.csv");
  methods << "method,grains,mean_ratio,deviation,least_ratio,largest_ratio,wrong_class_percent,"
             "too_coarse_percent,too_fine_percent,seconds_per_grain\n";
  each << "grain,exact_size_m,method,ratio\n";
  for (size_t m = 0; m < all.size(); ++m) {
    const std::string name = sieve_method_names()[m];
    double mean = 0, square = 0, coarse = 0, fine = 0;
    for (int k = 0; k < count; ++k) {
      double& r = all[m].ratio[k];
      r /= exact[k];
      mean += r / count, square += r * r / count;
      const int given = class_of(r * size[k]), true_class = class_of(size[k]);
      coarse += 100. / count * (given > true_class);
      fine += 100. / count * (given < true_class);
      each << k << ',' << size[k] << ',' << name << ',' << r << '\n';
    }
    const auto ends = std::minmax_element(all[m].ratio.begin(), all[m].ratio.end());
    char line[300];
    std::snprintf(line, sizeof line, "%s,%d,%.4f,%.4f,%.4f,%.4f,%.1f,%.1f,%.1f,%.3g\n",
                  name.c_str(), count, mean, std::sqrt(std::max(0.0, square - mean * mean)),
                  *ends.first, *ends.second, coarse + fine, coarse, fine, all[m].seconds);
    methods << line;
    std::printf("%s", line);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: sieve_methods_study FOLDER [GRAINS] [SEED] [SPACING]\n");
    return 2;
  }
  try {
    write(argv[1], argc > 2 ? std::atoi(argv[2]) : 1000, argc > 3 ? std::atoi(argv[3]) : 1,
          argc > 4 ? std::atof(argv[4]) : VoronoiParameters().spacing);
  } catch (const trackbed::InputError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
