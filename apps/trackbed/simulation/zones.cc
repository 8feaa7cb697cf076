#include "apps/trackbed/simulation/zones.h"

#include <algorithm>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/grain_estimate.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/materials.h"
#include "apps/trackbed/simulation/seam.h"

namespace trackbed::apps {
namespace {

using Block = dem::PlacementSpace::Block;

// Area in plan that two rectangles share.
double shared_area(const Block& a, const Block& b) {
  double area = 1;
  for (int k = 0; k < 2; ++k)
    area *= std::max(0.0, std::min(a.high[k], b.high[k]) - std::max(a.low[k], b.low[k]));
  return area;
}

Block footprint(const Layout& l) {
  return {{l.sleeper_low_x, l.sleeper_low_y, 0}, {l.sleeper_high_x, l.sleeper_high_y, 0}};
}

// Which zone each grain of a kind goes to: zones are filled one after the other, each to its share
// of the kind's mass. The draw is shuffled, so every zone gets the whole gradation.
void assign(const std::vector<dem::GrainShape>& grains, const std::vector<double>& share,
            std::vector<int>& zone) {
  double total = 0, sum = 0;
  for (const auto& g : grains) total += g.volume;
  for (const auto& g : grains) {
    sum += g.volume;
    const double middle = (sum - 0.5 * g.volume) / total;
    double end = 0;
    int k = 0;
    for (; k + 1 < static_cast<int>(share.size()); ++k)
      if (middle < (end += share[k])) break;
    zone.push_back(k);
  }
}

}  // namespace

Scene coarse_scene(const Scene& s) {
  Scene coarse = s;
  coarse.grains.generator = s.zones.generator;
  coarse.grains.points_least = coarse.grains.points_most = s.zones.vertices;
  // What is asked of the fine library's form is not asked of a simpler one.
  coarse.grains.elongation = coarse.grains.flatness = 0;
  coarse.grains.sphericity = coarse.grains.angularity = 0;
  coarse.gradation.needle_share = coarse.gradation.flaky_share = 0;
  coarse.grains.seed = s.grains.seed + 1;
  if (s.zones.curve != "scaled") {
    coarse.gradation.curve = s.zones.curve;
    return coarse;
  }
  const dem::SieveCurve own = gradation_curve(s);
  coarse.gradation.curve = "table";
  coarse.gradation.sieves = own.sieve;
  coarse.gradation.passing = own.passing;
  for (double& d : coarse.gradation.sieves) d *= s.zones.size_ratio;
  coarse.gradation.top_sieve = s.gradation.top_sieve * s.zones.size_ratio;
  return coarse;
}

std::vector<Block> zone_rectangles(const Scene& s, const Layout& l) {
  std::vector<Block> list;
  for (const double reach : {s.zones.margin, s.zones.margin + s.zones.transition}) {
    Block b = footprint(l);
    for (int k = 0; k < 2; ++k) {
      b.low[k] = std::max(l.low[k], b.low[k] - reach);
      b.high[k] = std::min(l.high[k], b.high[k] + reach);
    }
    list.push_back(b);
  }
  return list;
}

int zone_at(const std::vector<Block>& rectangles, const dem::Vec3& x) {
  int k = 0;
  for (const Block& b : rectangles) {
    if (x.x() >= b.low.x() && x.x() <= b.high.x() && x.y() >= b.low.y() && x.y() <= b.high.y())
      return k;
    ++k;
  }
  return k;
}

std::vector<Zone> make_zones(const Scene& s, const Layout& l, bool beside) {
  const auto rectangles = zone_rectangles(s, l);
  const Block sleeper = footprint(l);
  std::vector<Zone> zones{{"fine", 0, 1}, {"transition", 0, 0.5}, {"coarse", l.area, 0}};
  if (beside) zones[2].area -= shared_area(sleeper, {l.low, l.high});
  for (int k = 1; k >= 0; --k) {
    zones[k].area = shared_area(rectangles[k], {l.low, l.high});
    if (beside) zones[k].area -= shared_area(sleeper, rectangles[k]);
    zones[k + 1].area = std::max(0.0, zones[k + 1].area - zones[k].area);
  }
  return zones;
}

GrainBatch draw_batch(Run& run, double mass, int stream, bool beside) {
  const Scene& s = run.scene;
  GrainBatch batch;
  const double period = run.layout.period.y();
  if (run.library.empty()) run.library = make_grain_library(s, run.library_progress);
  if (!s.zones.use) {
    batch.grains = draw_grains(s, run.library, mass, stream);
    batch.fine = static_cast<int>(batch.grains.size());
    check_seam(period, batch.grains);
    return batch;
  }
  double area = 0, fine_area = 0;
  std::vector<double> fine, coarse;  // area of each zone that is theirs
  for (const Zone& z : make_zones(s, run.layout, beside)) {
    fine.push_back(z.area * z.fine), coarse.push_back(z.area * (1 - z.fine));
    area += z.area, fine_area += fine.back();
  }
  const auto draw = [&](const Scene& scene, const std::vector<dem::GrainShape>& library,
                        std::vector<double>& areas, double own) {
    if (!(own > 0)) return;  // beside the sleeper there may be no fine zone left
    for (double& a : areas) a /= own;
    const auto grains = draw_grains(scene, library, mass * own / area, stream);
    assign(grains, areas, batch.zone);
    batch.grains.insert(batch.grains.end(), grains.begin(), grains.end());
  };
  const Scene outside = coarse_scene(s);
  if (run.coarse_library.empty())
    run.coarse_library = make_grain_library(outside, run.library_progress);
  draw(s, run.library, fine, fine_area);
  batch.fine = static_cast<int>(batch.grains.size());
  draw(outside, run.coarse_library, coarse, area - fine_area);
  check_seam(period, batch.grains);
  return batch;
}

std::vector<ZoneEstimate> estimate_zones(const Scene& s) {
  const Layout l = make_layout(s);
  const auto per_mass = [&](const Scene& scene) {
    double grains = 0;
    for (const auto& k : gradation_classes(scene)) grains += k.grains;
    return grains / l.bed_mass;
  };
  const double fine = per_mass(s), coarse = per_mass(coarse_scene(s));
  std::vector<ZoneEstimate> list;
  for (const bool beside : {false, true}) {
    const auto zones = make_zones(s, l, beside);
    double area = 0;
    for (const Zone& z : zones) area += z.area;
    for (std::size_t k = 0; k < zones.size(); ++k) {
      if (!beside) list.push_back({zones[k].name, 0, 0, 0});
      const double mass = (beside ? l.fill_mass : l.bed_mass) * zones[k].area / area;
      list[k].mass += mass;
      list[k].grains += mass * (zones[k].fine * fine + (1 - zones[k].fine) * coarse);
      list[k].all_fine += mass * fine;
    }
  }
  return list;
}

void write_zones(const Run& run, const std::string& file) {
  const dem::Bodies& b = run.world.bodies;
  const auto rectangles = zone_rectangles(run.scene, run.layout);
  struct Count {
    int grains = 0, coarse = 0;
    double mass = 0, faces = 0;
  };
  std::vector<Count> counts(3);
  double fine_mass = 0;
  int fine = 0;
  for (int i = 0; i < b.grains; ++i) {
    Count& c = counts[zone_at(rectangles, b.x[i])];
    const bool coarse = b.material[i] == kCoarseGrain;
    ++c.grains, c.coarse += coarse, c.mass += b.mass[i];
    c.faces += static_cast<double>(run.world.shapes.shape(b.shape[i]).body.faces.size());
    if (!coarse) ++fine, fine_mass += b.mass[i];
  }
  const double per_mass = fine_mass > 0 ? fine / fine_mass : 0;
  const auto zones = make_zones(run.scene, run.layout, false);
  CsvWriter csv(file, {"zone", "grains", "fine_grains", "coarse_grains", "mass_kg", "mean_faces",
                       "grains_if_all_fine"});
  for (std::size_t k = 0; k < counts.size(); ++k) {
    const Count& c = counts[k];
    csv.row({zones[k].name, c.grains, c.grains - c.coarse, c.coarse, c.mass,
             c.grains ? CsvCell(c.faces / c.grains) : CsvCell(), c.mass * per_mass});
  }
  csv.flush();
}

}  // namespace trackbed::apps
