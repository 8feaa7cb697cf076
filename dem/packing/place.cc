#include "dem/packing/place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "dem/grain/random.h"

namespace trackbed::dem {
namespace {

// Columns of the plan view, each with the spheres that reach over it.
class Plan {
 public:
  Plan(const PlacementSpace& space, double largest) : space_(space) {
    for (int k = 0; k < 2; ++k) {
      const double length = space.high[k] - space.low[k];
      cells_[k] = std::max(1, static_cast<int>(length / (2 * largest)));
      width_[k] = length / cells_[k];
    }
    columns_.resize(cells_[0] * cells_[1]);
  }

  void add(const Vec3& x, double radius) {
    columns_[column(cell(x, 0), cell(x, 1))].push_back(static_cast<int>(centre_.size()));
    centre_.push_back(x);
    radius_.push_back(radius);
  }

  // Lowest height at which a sphere over (x, y) rests on what is there, or on the floor.
  double rest(double x, double y, double radius) const {
    double z = space_.low.z() + radius;
    const Vec3 p(x, y, 0);
    for (const int i : near(cell(p, 0), 0))
      for (const int j : near(cell(p, 1), 1)) {
        if (i < 0 || j < 0) continue;
        for (const int s : columns_[column(i, j)]) {
          const double sum = radius + radius_[s];
          const double h2 = sum * sum - plan_distance2(p, centre_[s]);
          if (h2 > 0) z = std::max(z, centre_[s].z() + std::sqrt(h2));
        }
      }
    return z;
  }

  bool in_zone(double x, double y, int zone) const {
    const auto inside = [&](const PlacementSpace::Block& b) {
      return x >= b.low.x() && x <= b.high.x() && y >= b.low.y() && y <= b.high.y();
    };
    const int zones = static_cast<int>(space_.zones.size());
    return (zone >= zones || inside(space_.zones[zone])) &&
           (zone == 0 || !inside(space_.zones[zone - 1]));
  }

  bool over_wall(double x, double y, double radius) const {
    if (space_.radius <= 0) return false;
    const Vec3 middle = 0.5 * (space_.low + space_.high);
    return std::hypot(x - middle.x(), y - middle.y()) > space_.radius - radius;
  }

  bool over_block(double x, double y, double radius) const {
    for (const auto& b : space_.blocks) {
      const double dx = std::max({b.low.x() - x, 0., x - b.high.x()});
      const double dy = std::max({b.low.y() - y, 0., y - b.high.y()});
      if (dx * dx + dy * dy < radius * radius) return true;
    }
    return false;
  }

 private:
  int cell(const Vec3& x, int k) const {
    return std::clamp(static_cast<int>((x[k] - space_.low[k]) / width_[k]), 0, cells_[k] - 1);
  }
  // The cell and its neighbours along k, each once; -1 = beyond a wall. Cells are two of the
  // largest radii wide, so no sphere reaches further.
  std::array<int, 3> near(int i, int k) const {
    const int n = cells_[k];
    if (n < 3) return {0, n - 1 > 0 ? 1 : -1, -1};
    const bool around = space_.period[k] > 0;
    return {i > 0 ? i - 1 : (around ? n - 1 : -1), i, i < n - 1 ? i + 1 : (around ? 0 : -1)};
  }
  int column(int i, int j) const { return i * cells_[1] + j; }
  double plan_distance2(const Vec3& p, const Vec3& q) const {
    double sum = 0;
    for (int k = 0; k < 2; ++k) {
      double d = p[k] - q[k];
      if (space_.period[k] > 0) d -= space_.period[k] * std::round(d / space_.period[k]);
      sum += d * d;
    }
    return sum;
  }

  const PlacementSpace& space_;
  int cells_[2];
  double width_[2];
  std::vector<std::vector<int>> columns_;
  std::vector<Vec3> centre_;
  std::vector<double> radius_;
};

// Uniform over all rotations (Shoemake 1992).
Quat random_rotation(Random& random) {
  const double u = random.uniform(), a = 2 * M_PI * random.uniform(),
               b = 2 * M_PI * random.uniform();
  const double s = std::sqrt(1 - u), t = std::sqrt(u);
  return Quat(t * std::cos(b), s * std::sin(a), s * std::cos(a), t * std::sin(b));
}

}  // namespace

Placement place_loose(const std::vector<double>& radii, const PlacementSpace& space,
                      const PlacedSpheres& present, int tries, std::uint64_t seed,
                      const std::vector<int>& zone) {
  double largest = 0;
  for (const double r : radii) largest = std::max(largest, r);
  for (const double r : present.radius) largest = std::max(largest, r);
  for (int k = 0; k < 2; ++k)
    if (space.period[k] == 0 && space.high[k] - space.low[k] < 2 * largest)
      throw InputError("Container: the largest grain (" + std::to_string(2e3 * largest) +
                       " mm across) does not fit between the walls");
  Plan plan(space, largest);
  for (std::size_t i = 0; i < present.centre.size(); ++i)
    plan.add(present.centre[i], present.radius[i]);

  Random random(seed);
  Placement placement;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    const double r = radii[i];
    Vec3 best(0, 0, std::numeric_limits<double>::infinity());
    int left = tries;
    for (int spot = 0; left > 0 && spot < 1000 * tries; ++spot) {
      const auto along = [&](int k) {
        const double margin = space.period[k] > 0 ? 0 : r;
        return random.uniform(space.low[k] + margin, space.high[k] - margin);
      };
      const double x = along(0), y = along(1);
      if (plan.over_block(x, y, r) || plan.over_wall(x, y, r)) continue;
      if (!zone.empty() && !plan.in_zone(x, y, zone[i])) continue;
      --left;
      const double z = plan.rest(x, y, r);
      if (z < best.z()) best = Vec3(x, y, z);
    }
    if (!std::isfinite(best.z()))
      throw InputError("Container: no room " +
                       std::string(!space.blocks.empty() ? "beside the sleeper "
                                   : zone.empty()        ? ""
                                                         : "in its zone ") +
                       "for a grain of " + std::to_string(2e3 * r) + " mm");
    plan.add(best, r);
    placement.centre.push_back(best);
    placement.turn.push_back(random_rotation(random));
  }
  return placement;
}

}  // namespace trackbed::dem
