#include "apps/trackbed/simulation/bearing.h"

#include <algorithm>
#include <cmath>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/actors.h"
#include "apps/trackbed/simulation/structures.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

constexpr double kCell = 0.05;  // of the pressure map [m]

struct BearingForce {
  Vec3 point, force;  // on the sleeper
};

std::vector<BearingForce> bearing_forces(const Run& run) {
  const coupling::World& w = run.world;
  std::vector<BearingForce> forces;
  if (run.actors.sleeper_surface >= 0) {
    const dem::PatchContacts& k = w.surfaces[run.actors.sleeper_surface].contacts;
    for (int i = 0; i < k.size(); ++i)
      if (k.touching[i]) forces.push_back({k.point[i], -k.force[i]});
  } else if (run.actors.rigid_sleeper) {
    const int body = moving_body(run);  // the last body: always b of its pairs
    for (int p = 0; p < w.pairs.size(); ++p)
      if (w.pairs.touching[p] && w.pairs.b[p] == body)
        forces.push_back({w.bodies.x[w.pairs.a[p]] + w.pairs.arm_a[p], -w.pairs.force[p]});
  }
  return forces;
}

struct Map {
  int nx, ny;
  double dx, dy;
};

Map map_of(const Layout& l) {
  Map m;
  const double lx = l.sleeper_high_x - l.sleeper_low_x, ly = l.sleeper_high_y - l.sleeper_low_y;
  m.nx = std::max(1, static_cast<int>(lx / kCell + 0.5));
  m.ny = std::max(1, static_cast<int>(ly / kCell + 0.5));
  m.dx = lx / m.nx, m.dy = ly / m.ny;
  return m;
}

}  // namespace

void keep_pressure(Run& run) {
  const Map m = map_of(run.layout);
  std::vector<double>& sum = run.stage.pressure;
  sum.resize(m.nx * m.ny, 0.0);
  const double base = run.actors.sleeper_base;
  for (const BearingForce& f : bearing_forces(run)) {
    if (f.point.z() > base + 0.02) continue;  // on the sleeper's side
    const int i =
        std::clamp(static_cast<int>((f.point.x() - run.layout.sleeper_low_x) / m.dx), 0, m.nx - 1);
    const int j =
        std::clamp(static_cast<int>((f.point.y() - run.layout.sleeper_low_y) / m.dy), 0, m.ny - 1);
    sum[i * m.ny + j] += f.force.z() / (m.dx * m.dy);
  }
  ++run.stage.pressure_samples;
}

void write_pressure(const Run& run, const std::string& file) {
  if (run.stage.pressure_samples == 0) return;
  const Map m = map_of(run.layout);
  CsvWriter csv(file, {"x_m", "y_m", "pressure_Pa"});
  for (int i = 0; i < m.nx; ++i)
    for (int j = 0; j < m.ny; ++j)
      csv.row({run.layout.sleeper_low_x + (i + 0.5) * m.dx,
               run.layout.sleeper_low_y + (j + 0.5) * m.dy,
               run.stage.pressure[i * m.ny + j] / run.stage.pressure_samples});
  csv.flush();
}

void write_moment(const Run& run, const std::string& file) {
  const Layout& l = run.layout;
  const std::vector<BearingForce> forces = bearing_forces(run);
  const SleeperScene& s = run.scene.sleeper;
  const double length = l.sleeper_high_x - l.sleeper_low_x;
  const double axis = run.actors.sleeper_base + 0.5 * s.height - deflection_at(run, 0);
  const double weight = 9.81 * s.density * s.width * s.height;  // [N/m]
  const std::vector<RailSeat> seats = rail_seats(run.scene);

  // With the half sleeper the moment at the plane of symmetry is found from the free end.
  const auto moment = [&](double x) {
    double sum = 0;
    for (const BearingForce& f : forces)
      if (f.point.x() > x)
        sum += f.force.z() * (f.point.x() - x) - f.force.x() * (f.point.z() - axis);
    const double load = run.stage.load * l.share / static_cast<double>(seats.size());
    for (const RailSeat& seat : seats) {
      const double low = std::max(x, seat.low);
      if (seat.high > low)
        sum -= load * (seat.high - low) / (seat.high - seat.low) * (0.5 * (low + seat.high) - x);
    }
    const double rest = l.sleeper_high_x - x;
    return sum - 0.5 * weight * rest * rest;
  };

  CsvWriter csv(file, {"x_m", "deflection_m", "moment_Nm"});
  const int points = 41;
  for (int k = 0; k < points; ++k) {
    const double x = l.sleeper_low_x + length * k / (points - 1);
    csv.row({x, deflection_at(run, x), moment(x)});
  }
  csv.flush();
}

double deflection_at(const Run& run, double x) {
  const coupling::World& w = run.world;
  if (run.actors.sleeper_surface < 0) {
    const int body = moving_body(run);
    const Vec3 along =
        w.bodies.R[body] * w.shapes.shape(w.bodies.shape[body]).turn.conjugate() * Vec3::UnitX();
    return run.actors.sleeper_start - w.bodies.x[body].z() - along.z() * x;
  }
  // Mean over the base's nodes by distance along the sleeper, linear between the two nearest rows.
  const dem::SurfacePatch& p = w.surfaces[run.actors.sleeper_surface].patch;
  const fem::SurfaceMesh& mesh = w.surfaces[run.actors.sleeper_surface].structure->surface();
  std::vector<std::pair<double, std::pair<double, int>>> rows;  // x, (sum of u, count)
  for (int i = 0; i < p.carried; ++i) {
    const auto& at = mesh.nodes[i];
    if (std::abs(at[2] - run.actors.sleeper_base) > 1e-6) continue;
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const auto& r) { return std::abs(r.first - at[0]) < 1e-6; });
    if (row == rows.end()) row = rows.insert(rows.end(), {at[0], {0, 0}});
    row->second.first -= p.node[i].z() - at[2];
    ++row->second.second;
  }
  if (rows.empty()) return 0;
  std::sort(rows.begin(), rows.end());
  const auto u = [&](std::size_t k) { return rows[k].second.first / rows[k].second.second; };
  std::size_t k = 1;
  while (k + 1 < rows.size() && rows[k].first < x) ++k;
  if (rows.size() == 1) return u(0);
  const double t = (x - rows[k - 1].first) / (rows[k].first - rows[k - 1].first);
  return u(k - 1) + t * (u(k) - u(k - 1));
}

}  // namespace trackbed::apps
