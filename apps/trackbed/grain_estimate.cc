#include "apps/trackbed/grain_estimate.h"

#include <algorithm>

namespace trackbed::apps {

dem::SieveCurve gradation_curve(const GradationScene& g) {
  dem::SieveCurve curve =
      g.curve == "table" ? dem::make_curve(g.sieves, g.passing) : dem::named_curve(g.curve);
  if (curve.passing.back() < 100) curve.top = g.top_sieve;
  return curve;
}

std::vector<GradationClass> gradation_classes(const Scene& scene) {
  const dem::SieveCurve curve = gradation_curve(scene.gradation);
  const double total = bed_mass(scene);
  std::vector<GradationClass> classes;
  for (const auto& k : dem::sieve_classes(curve)) {
    if (k.percent <= 0) continue;
    const double d = 0.5 * (k.low + k.high), mass = 0.01 * k.percent * total;
    classes.push_back({k.low, k.high, 0.01 * k.percent, mass,
                       mass / (scene.grains.density * 0.6 * d * d * d),
                       k.low >= curve.sieve.back()});
  }
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
