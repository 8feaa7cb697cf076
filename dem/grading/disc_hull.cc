#include "dem/grading/disc_hull.h"

#include <cmath>

namespace trackbed::dem {

std::vector<HullArc> disc_hull(const std::vector<Disc>& discs) {
  using Vec2 = Eigen::Vector2d;
  const int n = int(discs.size());
  int now = 0;
  for (int j = 1; j < n; ++j) {  // farthest along x, then the one that leads just after
    const double more = discs[j].x + discs[j].radius - discs[now].x - discs[now].radius;
    if (more > 0 || (more == 0 && discs[j].y > discs[now].y)) now = j;
  }
  std::vector<HullArc> arcs = {{0, now}};
  Vec2 d(1, 0);  // the direction reached
  double angle = 0;
  for (int step = 0; step < 4 * n; ++step) {
    // The disc that overtakes next: (c_j - c_now).v = R_now - R_j at the direction v of the common
    // tangent; the one of least turn from d.
    int next = -1;
    Vec2 best(0, 0);
    double best_turn = 0;
    for (int j = 0; j < n; ++j) {
      if (j == now) continue;
      const double x = discs[j].x - discs[now].x, y = discs[j].y - discs[now].y;
      const double gap = discs[now].radius - discs[j].radius, dd = x * x + y * y;
      const double h2 = dd - gap * gap;
      if (!(h2 > 0)) continue;  // one inside the other
      const double h = std::sqrt(h2);
      const Vec2 v((x * gap + y * h) / dd, (y * gap - x * h) / dd);
      // Turn from d to v in [0, 2 pi), by a number that rises with it.
      const double c = d.dot(v), s = d.x() * v.y() - d.y() * v.x();
      double turn = s >= 0 ? 1 - c : 3 + c;
      if (s < 0 && s > -1e-12 && c > 0) turn = 0;  // rounding behind d
      // Of those that tie, the one that leads afterwards: farthest along the tangent.
      const auto reach = [&](int k) { return -discs[k].x * v.y() + discs[k].y * v.x(); };
      if (next < 0 || turn < best_turn - 1e-14 ||
          (turn < best_turn + 1e-14 && reach(j) > reach(next)))
        next = j, best = v, best_turn = turn;
    }
    if (next < 0) break;
    angle += std::atan2(d.x() * best.y() - d.y() * best.x(), d.dot(best)) +
             (best_turn > 2 ? 2 * M_PI : 0);
    if (angle >= 2 * M_PI) break;
    d = best, now = next;
    arcs.push_back({std::max(angle, arcs.back().angle), now});
  }
  return arcs;
}

}  // namespace trackbed::dem
