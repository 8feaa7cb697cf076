#include "dem/grain/disc_region.h"

#include <cmath>

namespace trackbed::dem {
namespace {

using Mat2 = Eigen::Matrix2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

void add_triangle(DiscRegion& r, const Vec2& a, const Vec2& b, double h) {
  const double area = 0.5 * cross(a, b), s = std::abs(h);
  const Vec2 sum = a + b;
  r.area += area;
  r.first += area / 3 * sum;
  r.second += area / 12 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  const double p = std::hypot(a.norm(), h), q = std::hypot(b.norm(), h);
  const double angle = 2 * std::atan2(cross(a, b), (p + s) * (q + s) + a.dot(b));
  r.angle += h < 0 ? -angle : angle;
}

void add_sector(DiscRegion& r, const Vec2& a, const Vec2& b, double rho, double h, double radius) {
  const double turn = std::atan2(cross(a, b), a.dot(b));
  const double from = std::atan2(a.y(), a.x()), to = from + turn;
  const double c = 0.25 * (std::sin(2 * to) - std::sin(2 * from));
  const double s = 0.5 * (std::pow(std::sin(to), 2) - std::pow(std::sin(from), 2));
  const double rho2 = rho * rho;
  r.area += 0.5 * rho2 * turn;
  r.first += rho2 * rho / 3 * Vec2(std::sin(to) - std::sin(from), std::cos(from) - std::cos(to));
  Mat2 m;
  m << 0.5 * turn + c, s, s, 0.5 * turn - c;
  r.second += 0.25 * rho2 * rho2 * m;
  const double angle = turn * (1 - std::abs(h) / radius);
  r.angle += h < 0 ? -angle : angle;
}

}  // namespace

DiscRegion disc_within(const std::vector<Vec2>& polygon, double rho, double h, double radius) {
  DiscRegion r;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k], b = polygon[(k + 1) % polygon.size()], d = b - a;
    const double dd = d.squaredNorm();
    if (dd == 0) continue;
    const double ad = a.dot(d);
    const double root2 = ad * ad - dd * (a.squaredNorm() - rho * rho);
    const double root = root2 > 0 ? std::sqrt(root2) : 0;
    const double in = std::max(0.0, (-ad - root) / dd), out = std::min(1.0, (-ad + root) / dd);
    if (root2 <= 0 || in >= out) {
      add_sector(r, a, b, rho, h, radius);
      continue;
    }
    const Vec2 p = a + in * d, q = a + out * d;
    if (in > 0) add_sector(r, a, p, rho, h, radius);
    add_triangle(r, p, q, h);
    if (out < 1) add_sector(r, q, b, rho, h, radius);
  }
  return r;
}

}  // namespace trackbed::dem
