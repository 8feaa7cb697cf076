#include "dem/packing/section.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace trackbed::dem {
namespace {

Vec2 in_picture(const Vec3& p, int axis) {
  return axis == 0 ? Vec2(p.y(), p.z()) : axis == 1 ? Vec2(p.x(), p.z()) : Vec2(p.x(), p.y());
}

// Where the plane cuts the edges, in order round the middle: the body is convex.
std::vector<Vec2> cut(const Polyhedron& body, const std::vector<Vec3>& at,
                      const CuttingPlane& plane) {
  std::vector<Vec2> points;
  for (const auto& face : body.faces)
    for (size_t k = 0; k < face.size(); ++k) {
      const int i = face[k], j = face[(k + 1) % face.size()];
      const double a = at[i][plane.axis] - plane.position, b = at[j][plane.axis] - plane.position;
      // Each edge belongs to two faces, once in each direction.
      if (a < 0 && b >= 0)
        points.push_back(in_picture(at[i] + a / (a - b) * (at[j] - at[i]), plane.axis));
    }
  Vec2 middle = Vec2::Zero();
  for (const Vec2& p : points) middle += p / double(points.size());
  std::sort(points.begin(), points.end(), [&](const Vec2& p, const Vec2& q) {
    const Vec2 a = p - middle, b = q - middle;
    return std::atan2(a.y(), a.x()) < std::atan2(b.y(), b.x());
  });
  return points;
}

std::vector<Vec2> disc_outline(const Vec2& centre, double radius) {
  std::vector<Vec2> outline;
  for (int k = 0; k < 48; ++k)
    outline.push_back(centre + radius * Vec2(std::cos(M_PI * k / 24), std::sin(M_PI * k / 24)));
  return outline;
}

void add_pieces(const PlacedGrain& g, int grain, const Vec3& x, const CuttingPlane& plane,
                std::vector<SectionPiece>& pieces) {
  for (const Sphere& s : g.outline->spheres) {
    const Vec3 c = x + g.R * s.centre;
    const double d = plane.position - c[plane.axis];
    if (std::abs(d) < s.radius)
      pieces.push_back({grain, disc_outline(in_picture(c, plane.axis),
                                            std::sqrt((s.radius - d) * (s.radius + d)))});
  }
  for (const Polyhedron& body : g.outline->bodies) {
    std::vector<Vec3> at;
    for (const Vec3& v : body.vertices) at.push_back(x + g.R * v);
    std::vector<Vec2> outline = cut(body, at, plane);
    if (outline.size() >= 3) pieces.push_back({grain, std::move(outline)});
  }
}

}  // namespace

std::vector<SectionPiece> section(const std::vector<PlacedGrain>& grains, const Vec3& period,
                                  const CuttingPlane& plane) {
  std::vector<SectionPiece> pieces;
  for (int i = 0; i < int(grains.size()); ++i) {
    const PlacedGrain& g = grains[i];
    // Images are drawn where the grain reaches over its seam; along the cut's axis the nearest.
    std::vector<Vec3> shifts = {Vec3::Zero()};
    for (int k = 0; k < 3; ++k)
      if (period[k] > 0) {
        const size_t n = shifts.size();
        for (size_t s = 0; s < n; ++s)
          for (int side : {-1, 1}) shifts.push_back(shifts[s] + side * period[k] * Vec3::Unit(k));
      }
    for (const Vec3& shift : shifts) {
      const Vec3 x = g.x + shift;
      if (std::abs(x[plane.axis] - plane.position) < g.radius) add_pieces(g, i, x, plane, pieces);
    }
  }
  return pieces;
}

std::string to_csv(const std::vector<CuttingPlane>& planes,
                   const std::vector<std::vector<SectionPiece>>& sections) {
  std::string text = "axis,position_m,piece,grain,a_m,b_m\n";
  char line[160];
  int piece = 0;
  for (size_t k = 0; k < planes.size(); ++k)
    for (const SectionPiece& p : sections[k]) {
      for (const Vec2& c : p.outline) {
        std::snprintf(line, sizeof line, "%c,%.6g,%d,%d,%.6g,%.6g\n", "xyz"[planes[k].axis],
                      planes[k].position, piece, p.grain, c.x(), c.y());
        text += line;
      }
      ++piece;
    }
  return text;
}

std::vector<CuttingPlane> evenly_spaced(const MeasuredRegion& r, int axis, int count) {
  const double low = axis == 2 ? r.low_z : r.low[axis], high = axis == 2 ? r.high_z : r.high[axis];
  std::vector<CuttingPlane> planes;
  for (int k = 0; k < count; ++k)
    planes.push_back({axis, low + (high - low) * (k + 1) / (count + 1)});
  return planes;
}

}  // namespace trackbed::dem
