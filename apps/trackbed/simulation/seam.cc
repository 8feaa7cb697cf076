#include "apps/trackbed/simulation/seam.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/trackbed/simulation/zones.h"
#include "base/error.h"

namespace trackbed::apps {

void check_seam(double period, const std::vector<dem::GrainShape>& grains) {
  if (period == 0) return;
  double radius = 0;
  for (const dem::GrainShape& g : grains) radius = std::max(radius, g.radius);
  const double skin = 0.1 * radius;  // of the mean radius at most: candidates.cc
  const double least = 3 * (2 * radius + skin);
  if (period >= least) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "Container/Periodic along track: the period of %.0f mm is less than three of the "
                "largest grains drawn (%.0f mm long); at least %.0f mm",
                1000 * period, 2000 * radius, std::ceil(1000 * least));
  throw InputError(text);
}

void check_seam_of_drawn(const Scene& scene) {
  Run run;
  run.scene = scene;
  run.layout = sample_layout(scene);
  if (run.layout.period.y() == 0 || !scene.packing.start_from.empty()) return;
  draw_batch(run, run.layout.bed_mass / scene.packing.layers, 0, false);
  if (run.layout.fill_mass > 0) draw_batch(run, run.layout.fill_mass, 1, true);
}

}  // namespace trackbed::apps
