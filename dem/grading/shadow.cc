#include "dem/grading/shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trackbed::dem {
namespace {

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// The chord between the two supporting points of the polygon in direction d: width = chord.d.
Vec2 chord(const std::vector<Vec2>& polygon, const Vec2& d) {
  const auto less = [&](const Vec2& a, const Vec2& b) { return a.dot(d) < b.dot(d); };
  const auto ends = std::minmax_element(polygon.begin(), polygon.end(), less);
  return *ends.second - *ends.first;
}

Vec2 unit(double angle) { return {std::cos(angle), std::sin(angle)}; }
Vec2 turned(const Vec2& d) { return {-d.y(), d.x()}; }

}  // namespace

std::vector<Vec3> face_areas(const Polyhedron& body) {
  std::vector<Vec3> areas;
  for (const auto& face : body.faces) {
    Vec3 twice = Vec3::Zero();
    const Vec3& a = body.vertices[face[0]];
    for (size_t k = 1; k + 1 < face.size(); ++k)
      twice += (body.vertices[face[k]] - a).cross(body.vertices[face[k + 1]] - a);
    areas.push_back(0.5 * twice);
  }
  return areas;
}

double shadow_area(const std::vector<Vec3>& areas, const Vec3& u) {
  double sum = 0;
  for (const Vec3& a : areas) sum += std::abs(a.dot(u));
  return 0.5 * sum;
}

std::vector<Vec2> shadow(const Polyhedron& body, const Vec3& u) {
  const Vec3 e1 = u.unitOrthogonal(), e2 = u.cross(e1);
  std::vector<Vec2> points;
  for (const Vec3& v : body.vertices) points.emplace_back(v.dot(e1), v.dot(e2));
  std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Vec2> hull;  // monotone chain: lower side, then upper side
  for (int side = 0; side < 2; ++side) {
    const size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  // Corners that differ by rounding (an edge of the body along u) are one: the side between them
  // would have any direction.
  const double tiny = 1e-12 * (points.back() - points.front()).norm();
  std::vector<Vec2> corners;
  for (const Vec2& p : hull)
    if (corners.empty() || (p - corners.back()).norm() > tiny) corners.push_back(p);
  while (corners.size() > 1 && (corners.back() - corners.front()).norm() <= tiny)
    corners.pop_back();
  return corners;
}

namespace {

// The rectangles around the polygon with one side on a side of it.
std::vector<Rectangle> flush_rectangles(const std::vector<Vec2>& polygon) {
  std::vector<Rectangle> all;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 side = polygon[(k + 1) % polygon.size()] - polygon[k];
    if (side.norm() == 0) continue;
    const Vec2 d = side.normalized();
    const double a = chord(polygon, d).dot(d), b = chord(polygon, turned(d)).dot(turned(d));
    all.push_back({std::max(a, b), std::min(a, b)});
  }
  return all;
}

}  // namespace

Rectangle least_rectangle(const std::vector<Vec2>& polygon) {
  const auto all = flush_rectangles(polygon);
  return *std::min_element(all.begin(), all.end(), [](const Rectangle& a, const Rectangle& b) {
    return a.p * a.q < b.p * b.q;
  });
}

double least_flush_square(const std::vector<Vec2>& polygon) {
  const auto all = flush_rectangles(polygon);
  return std::min_element(all.begin(), all.end(),
                          [](const Rectangle& a, const Rectangle& b) { return a.p < b.p; })
      ->p;
}

double least_square(const std::vector<Vec2>& polygon) {
  const double quarter = std::acos(0.0);
  std::vector<double> events;
  for (size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 side = polygon[(k + 1) % polygon.size()] - polygon[k];
    double angle = std::fmod(std::atan2(side.y(), side.x()), quarter);
    events.push_back(angle < 0 ? angle + quarter : angle);
  }
  std::sort(events.begin(), events.end());
  events.push_back(events.front() + quarter);

  double best = std::numeric_limits<double>::infinity();
  const auto try_angle = [&](double angle) {
    const Vec2 d = unit(angle), e = turned(d);
    best = std::min(best, std::max(chord(polygon, d).dot(d), chord(polygon, e).dot(e)));
  };
  for (size_t k = 0; k + 1 < events.size(); ++k) {
    try_angle(events[k]);
    const double middle = 0.5 * (events[k] + events[k + 1]);
    // both chords stay the same in between; the widths are equal where a.d(t) - b.e(t) = c.d(t) = 0
    const Vec2 a = chord(polygon, unit(middle)), b = chord(polygon, turned(unit(middle)));
    const Vec2 c(a.x() - b.y(), a.y() + b.x());
    const double root = std::atan2(-c.x(), c.y());
    for (int m = -4; m <= 4; ++m) {
      const double t = root + m * quarter * 2;
      if (t > events[k] && t < events[k + 1]) try_angle(t);
    }
  }
  return best;
}

}  // namespace trackbed::dem
