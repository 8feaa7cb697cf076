#include "apps/trackbed/simulation/subgrade_bearing.h"

#include <algorithm>
#include <cmath>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/bearing.h"
#include "apps/trackbed/simulation/structures.h"
#include "dem/contact/pairs.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

constexpr double kCell = 0.05;  // wanted size of the map's cells [m]

// Calls f(point, downward force) for each contact of a grain with the subgrade.
template <class F>
void for_each_force(const Run& run, F&& f) {
  const coupling::World& w = run.world;
  if (run.actors.subgrade_surface >= 0) {
    const dem::PatchContacts& k = w.surfaces[run.actors.subgrade_surface].contacts;
    for (int i = 0; i < k.size(); ++i)
      if (k.touching[i]) f(k.point[i], k.force[i].z());
  } else if (run.actors.floor) {
    const int floor = w.bodies.grains + run.actors.walls - 1;  // the last of the walls
    for (int p = 0; p < w.pairs.size(); ++p)
      if (w.pairs.touching[p] && w.pairs.b[p] == floor)
        f(w.bodies.x[w.pairs.a[p]] + w.pairs.arm_a[p], w.pairs.force[p].z());
  }
}

// Cell of [low, high] that holds x; what has left the box counts at its rim.
int cell_of(double x, double low, double high, int cells) {
  return std::clamp(static_cast<int>((x - low) / (high - low) * cells), 0, cells - 1);
}

}  // namespace

void write_subgrade_pressure(const Run& run, const std::string& folder) {
  const Vec3 low = run.layout.low, high = run.layout.high;
  const double lx = high.x() - low.x(), ly = high.y() - low.y();
  const int nx = std::max(1, static_cast<int>(lx / kCell + 0.5)),
            ny = std::max(1, static_cast<int>(ly / kCell + 0.5));
  const double area = lx / nx * ly / ny;
  std::vector<double> pressure(nx * ny, 0.0);
  for_each_force(run, [&](Vec3 point, double force) {
    if (run.layout.period.y() > 0)
      point += dem::nearest_image(0.5 * (low + high), point, run.layout.period);
    pressure[cell_of(point.x(), low.x(), high.x(), nx) * ny +
             cell_of(point.y(), low.y(), high.y(), ny)] += force / area;
  });
  CsvWriter map(folder + "/subgrade_pressure.csv", {"x_m", "y_m", "pressure_Pa"});
  CsvWriter profile(folder + "/subgrade_pressure_profile.csv", {"x_m", "pressure_Pa"});
  for (int i = 0; i < nx; ++i) {
    const double x = low.x() + (i + 0.5) * lx / nx;
    double sum = 0;
    for (int j = 0; j < ny; ++j) {
      map.row({x, low.y() + (j + 0.5) * ly / ny, pressure[i * ny + j]});
      sum += pressure[i * ny + j];
    }
    profile.row({x, sum / ny});
  }
  map.flush();
  profile.flush();
}

void write_rail_seats(const Run& run, const std::string& file) {
  const std::vector<RailSeat> seats = rail_seats(run.scene);
  CsvWriter csv(file, {"seat", "x_m", "load_N", "displacement_m", "rail_displacement_m"});
  // Also of a seat that is half simulated: the whole load.
  const double load = run.stage.load / static_cast<double>(run.scene.sleeper.seats.size());
  for (std::size_t k = 0; k < seats.size(); ++k) {
    double u = deflection_at(run, seats[k].x);
    if (run.actors.sleeper_surface >= 0) {
      const fem::Structure& s = *run.world.surfaces[run.actors.sleeper_surface].structure;
      if (static_cast<int>(k) < s.loads()) u = -s.load_displacement(static_cast<int>(k))[2];
    }
    csv.row({static_cast<int>(k + 1), seats[k].x, load, u, u + run.stage.pad});
  }
  csv.flush();
}

}  // namespace trackbed::apps
