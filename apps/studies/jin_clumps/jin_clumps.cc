// Jin, Zeng, Ye, Li 2017, Tables 1 and 2: volumes of spheres by virtual slices against the exact
// ones, and how much of a stone its filling with 344, 93, 47 spheres leaves out.
// usage: jin_clumps_study FOLDER [STONES]; writes FOLDER/table1.csv and table2.csv
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/clump.h"
#include "dem/grain/jin.h"

namespace {

using namespace trackbed::dem;

double ball(double r) { return 4 / 3. * M_PI * r * r * r; }

// Distance of two spheres whose common part has the given volume.
double distance(double r, double s, double lens) {
  double near = std::abs(r - s), far = r + s;
  for (int k = 0; k < 200; ++k) {
    const double d = 0.5 * (near + far);
    const double v = M_PI * std::pow(r + s - d, 2) *
                     (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d);
    (v > lens ? near : far) = d;
  }
  return near;
}

// One, two, three spheres in a row, the least of 7 mm, of the volumes the paper gives [cm].
void table1(const std::string& folder) {
  const double printed[] = {1.4367, 5.0961, 9.2326}, by_pixels[] = {1.4755, 5.1864, 9.3786};
  std::vector<Sphere> row = {{{0, 0, 0}, 0.7}};
  const Vec3 side = Vec3(1, 2, -0.7).normalized();
  std::ofstream out(folder + "/table1.csv");
  out << "spheres,exact_cm3,slices_cm3,error_percent,paper_cm3,paper_error_percent\n";
  for (int n = 1; n <= 3; ++n) {
    if (n == 2) row.push_back({distance(0.7, 1, ball(0.7) + ball(1) - printed[1]) * side, 1});
    if (n == 3) {
      const double d = distance(1, 1.05, printed[1] + ball(1.05) - printed[2]);
      row.push_back({row[1].centre + d * side, 1.05});
    }
    const double exact = mass_properties(row).volume, slices = sliced_volume(row, 100);
    char line[200];
    std::snprintf(line, sizeof line, "%d,%.6f,%.6f,%.5f,%.4f,%.2f\n", n, exact, slices,
                  100 * (slices / exact - 1), by_pixels[n - 1],
                  100 * (by_pixels[n - 1] / printed[n - 1] - 1));
    out << line;
    std::printf("%s", line);
  }
}

void table2(const std::string& folder, int stones) {
  const struct {
    double least, factor;
    int spheres;
    double left_out;
  } rows[] = {{0.002, 1.15, 344, 6.2}, {0.005, 1.3, 93, 18.3}, {0.007, 1.3, 47, 23.7}};
  std::ofstream out(folder + "/table2.csv");
  out << "least_radius_m,space_factor,stone,volume_m3,spheres,left_out_percent,sieve_m,"
         "paper_spheres,paper_left_out_percent\n";
  for (const auto& row : rows) {
    Random random(1);
    double spheres = 0, left_out = 0;
    for (int k = 0; k < stones; ++k) {
      const TriangleSolid stone = jin_stone({}, random);
      FillingParameters p;
      p.least_radius = row.least, p.space_factor = row.factor;
      const auto clump = fill_with_spheres(stone, p);
      const double v = mass_properties(stone).volume;
      const double missing = 100 * (1 - mass_properties(clump).volume / v);
      spheres += double(clump.size()) / stones, left_out += missing / stones;
      out << row.least << ',' << row.factor << ',' << k << ',' << v << ',' << clump.size() << ','
          << missing << ',' << sieve_size(clump) << ',' << row.spheres << ',' << row.left_out
          << '\n';
    }
    std::printf("R_lim %.0f mm, K %.2f: %.0f spheres (paper %d), %.1f %% left out (paper %.1f)\n",
                1000 * row.least, row.factor, spheres, row.spheres, left_out, row.left_out);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: jin_clumps_study FOLDER [STONES]\n");
    return 2;
  }
  try {
    std::filesystem::create_directories(argv[1]);
    table1(argv[1]);
    table2(argv[1], argc > 2 ? std::atoi(argv[2]) : 60);
  } catch (const trackbed::InputError& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
