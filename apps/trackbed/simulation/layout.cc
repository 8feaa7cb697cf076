#include "apps/trackbed/simulation/layout.h"

#include <algorithm>
#include <cmath>

namespace trackbed::apps {

double half_width(const Scene& s, double base, double z) {
  const double box = 0.5 * s.container.length;
  if (s.container.shoulder_width == 0) return box;
  const double top = 0.5 * s.sleeper.length + s.container.shoulder_width;
  const double height = base + s.container.fill_height;
  return std::min(box, top + s.container.shoulder_slope * std::max(0.0, height - z));
}

Layout make_layout(const Scene& s) {
  const ContainerScene& c = s.container;
  Layout l;
  l.low = {c.half ? 0 : -0.5 * c.length, -0.5 * c.width, 0};
  l.high = {0.5 * c.length, 0.5 * c.width, 0};
  l.period = {0, c.periodic ? c.width : 0, 0};
  const double round = c.shape == "cylinder" ? M_PI / 4 : 1;
  l.area = round * (l.high.x() - l.low.x()) * (l.high.y() - l.low.y());
  l.share = c.half ? 0.5 : 1;
  l.sleeper_low_x = c.half ? 0 : -0.5 * s.sleeper.length;
  l.sleeper_high_x = 0.5 * s.sleeper.length;
  l.sleeper_low_y = -0.5 * s.sleeper.width;
  l.sleeper_high_y = 0.5 * s.sleeper.width;

  // Below the sleeper's base the box is filled to its walls, and shoulders are cut out of that bed.
  const double below = c.length * c.depth;
  // Area of the cross-section beside the sleeper, by slices.
  const int slices = 1000;
  double beside = 0;
  for (int k = 0; k < slices; ++k) {
    const double z = (k + 0.5) / slices;
    beside += 2 * half_width(s, c.depth, c.depth + z * c.fill_height) * c.fill_height / slices;
  }
  const double sleeper =
      s.sleeper.length * s.sleeper.width * std::min(c.fill_height, s.sleeper.height);
  l.bed_mass = s.packing.bulk_density * below * c.width * round * l.share;
  // A test of grains has none.
  l.fill_mass = s.test.on() ? 0
                            : s.packing.bulk_density *
                                  std::max(0.0, beside * c.width * round - sleeper) * l.share;
  return l;
}

Layout sample_layout(const Scene& s) {
  Scene sample = s;
  sample.container.width /= s.packing.bays;
  return make_layout(sample);
}

}  // namespace trackbed::apps
