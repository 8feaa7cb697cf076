#include "apps/trackbed/grain_estimate.h"

#include <algorithm>

namespace trackbed::apps {

void gradation_curve(const GradationScene& g, std::vector<double>& sieves,
                     std::vector<double>& passing) {
  if (g.curve == "table") {
    sieves = g.sieves;
    passing = g.passing;
    return;
  }
  // Shao 2017, Table 4.
  sieves = {0.016, 0.025, 0.0355, 0.045, 0.056, 0.063};
  if (g.curve == "shao_large")
    passing = {0, 0, 0, 0, 0, 100};
  else if (g.curve == "shao_small")
    passing = {0, 0, 100, 100, 100, 100};
  else
    passing = {0, 0, 4, 33, 79, 95};
}

std::vector<GradationClass> gradation_classes(const Scene& scene) {
  std::vector<double> sieves, passing;
  gradation_curve(scene.gradation, sieves, passing);
  const double total = bed_mass(scene);
  std::vector<GradationClass> classes;
  auto add = [&](double lower, double upper, double percent, bool open) {
    if (percent <= 0) return;
    const double d = 0.5 * (lower + upper), mass = 0.01 * percent * total;
    classes.push_back({lower, upper, 0.01 * percent, mass,
                       mass / (scene.grains.density * 0.6 * d * d * d), open});
  };
  if (sieves.empty()) return classes;
  add(0.5 * sieves.front(), sieves.front(), passing.front(), false);
  for (std::size_t i = 1; i < sieves.size(); ++i)
    add(sieves[i - 1], sieves[i], passing[i] - passing[i - 1], false);
  add(sieves.back(), scene.gradation.top_sieve, 100 - passing.back(), true);
  return classes;
}

double bed_volume(const ContainerScene& box) {
  return box.length * box.width * box.depth * (box.half ? 0.5 : 1.0);
}

namespace {

/// Ballast between the base and the level of the sleeper's base; shoulders slope off to both sides
/// of the shoulder's top at sleeper.length/2 + shoulder width, fill height above that level [m3].
double bed_ballast(const Scene& scene) {
  const auto& box = scene.container;
  if (box.shoulder_width <= 0) return bed_volume(box);
  const double top = scene.sleeper.length + 2 * box.shoulder_width;  // width of the crown
  const double level = top + 2 * box.shoulder_slope * box.fill_height;
  const double base = level + 2 * box.shoulder_slope * box.depth;
  return 0.5 * (level + base) * box.depth * box.width * (box.half ? 0.5 : 1.0);
}

double fill_ballast(const Scene& scene) {
  const auto& box = scene.container;
  const auto& s = scene.sleeper;
  double across = box.length;  // mean width of the layer beside the sleeper
  if (box.shoulder_width > 0)
    across = s.length + 2 * box.shoulder_width + box.shoulder_slope * box.fill_height;
  const double layer = across * box.width - s.length * s.width;
  return std::max(0.0, layer) * std::min(box.fill_height, s.height) * (box.half ? 0.5 : 1.0);
}

}  // namespace

double bed_mass(const Scene& scene) { return scene.packing.bulk_density * bed_ballast(scene); }

double fill_mass(const Scene& scene) { return scene.packing.bulk_density * fill_ballast(scene); }

}  // namespace trackbed::apps
