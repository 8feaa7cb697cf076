#include "apps/trackbed/simulation/measures.h"

#include <cmath>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/files.h"
#include "apps/trackbed/simulation/actors.h"
#include "dem/grain/library_report.h"
#include "dem/packing/section.h"

namespace trackbed::apps {
namespace {

double bed_top(const Run& run) {
  if (run.actors.plate) return bed_height(run);
  if (run.actors.rigid_sleeper || run.actors.sleeper_surface >= 0)
    return run.actors.sleeper_base - sleeper_displacement(run);
  return highest_grain(run, -HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL);
}

void write_porosity(const std::vector<dem::PlacedGrain>& grains, const Run& run,
                    const dem::MeasuredRegion& region, const std::string& file) {
  const auto contacts = dem::grain_contacts(run.world.pairs, run.world.bodies.grains);
  const dem::Vec3& period = run.layout.period;
  const int layers = run.scene.measures.layers;
  CsvWriter csv(file, {"layer", "z_low_m", "z_high_m", "porosity", "void_ratio",
                       "density_kg_per_m3", "grains", "coordination"});
  const auto row = [&](int layer, double low, double high, const dem::RegionMeasure& m) {
    csv.row({layer, low, high, m.porosity, m.void_ratio, m.density, m.grains, m.coordination});
  };
  row(0, region.low_z, region.high_z, dem::measure(grains, contacts, period, region));
  const auto profile = dem::measure_layers(grains, contacts, period, region, layers);
  const double thickness = (region.high_z - region.low_z) / layers;
  for (int k = 0; k < layers; ++k)
    row(k + 1, region.low_z + k * thickness, region.low_z + (k + 1) * thickness, profile[k]);
  csv.flush();
}

void write_sections(const std::vector<dem::PlacedGrain>& grains, const Run& run,
                    const dem::MeasuredRegion& region, const std::string& file) {
  auto planes = dem::evenly_spaced(region, 2, run.scene.measures.horizontal_cuts);
  for (const auto& p : dem::evenly_spaced(region, 1, run.scene.measures.vertical_cuts))
    planes.push_back(p);
  std::vector<std::vector<dem::SectionPiece>> sections;
  for (const auto& p : planes) sections.push_back(dem::section(grains, run.layout.period, p));
  write_aside_then_rename(file, dem::to_csv(planes, sections));
}

}  // namespace

dem::MeasuredRegion measured_region(const Run& run) {
  const MeasureScene& m = run.scene.measures;
  dem::Vec3 low = run.layout.low, high = run.layout.high;
  if (!m.low.empty()) {
    low = dem::Vec3(m.low[0], m.low[1], m.low[2]),
    high = dem::Vec3(m.high[0], m.high[1], m.high[2]);
  } else {
    high.z() = bed_top(run);
    if (run.scene.container.shoulder_width > 0)
      low.x() = run.layout.sleeper_low_x, high.x() = run.layout.sleeper_high_x;
  }
  const bool cylinder = m.low.empty() && run.scene.container.shape == "cylinder";
  const double radius = m.radius == 0 && cylinder ? 0.5 * run.scene.container.length : m.radius;
  if (radius == 0) return dem::box_region(low, high);
  const dem::Vec2 middle = 0.5 * (low + high).head<2>();
  return dem::cylinder_region(middle, radius, low.z(), high.z());
}

void write_measures(const Run& run, const std::string& folder) {
  const dem::Bodies& b = run.world.bodies;
  if (b.grains == 0) return;
  const auto grains = dem::placed_grains(b, run.world.shapes);
  const dem::MeasuredRegion region = measured_region(run);
  write_porosity(grains, run, region, folder + "/porosity.csv");
  write_sections(grains, run, region, folder + "/sections.csv");
  std::vector<dem::GrainShape> shapes;
  for (int i = 0; i < b.grains; ++i) shapes.push_back(run.world.shapes.shape(b.shape[i]));
  write_aside_then_rename(folder + "/library.csv", dem::to_csv(dem::library_report(shapes)));
}

}  // namespace trackbed::apps
