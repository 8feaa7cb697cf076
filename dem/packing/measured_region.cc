#include "dem/packing/measured_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "dem/grain/disc_region.h"

namespace trackbed::dem {
namespace {

Vec2 plan(const Vec3& p) { return p.head<2>(); }

Vec2 middle(const MeasuredRegion& r) { return 0.5 * (r.low + r.high); }

MeasuredRegion checked(const MeasuredRegion& r) {
  if (!r.low.allFinite() || !r.high.allFinite() || !(r.low.x() < r.high.x()) ||
      !(r.low.y() < r.high.y()) || !(r.low_z < r.high_z) || !std::isfinite(r.high_z - r.low_z))
    throw InputError("measured region: low must lie below high in every direction, all finite");
  return r;
}

// The part of a polygon with sign * p[axis] <= sign * bound.
void clip(const std::vector<Vec3>& in, int axis, double sign, double bound,
          std::vector<Vec3>& out) {
  out.clear();
  for (size_t k = 0; k < in.size(); ++k) {
    const Vec3 &a = in[k], &b = in[(k + 1) % in.size()];
    const double da = sign * (a[axis] - bound), db = sign * (b[axis] - bound);
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
      Vec3 p = a + da / (da - db) * (b - a);
      p[axis] = bound;
      out.push_back(p);
    }
  }
}

// Integral of z over the polygon's projection, signed as it runs; 0 for fewer than three corners.
double under_polygon(const std::vector<Vec3>& p) {
  double sum = 0;
  for (size_t k = 2; k < p.size(); ++k) {
    const Vec3 a = p[k - 1] - p[0], b = p[k] - p[0];
    sum += (a.x() * b.y() - a.y() * b.x()) / 6 * (p[0].z() + p[k - 1].z() + p[k].z());
  }
  return sum;
}

// The same over the part within the disc about the origin; z is linear in plan.
double under_polygon_in_disc(const std::vector<Vec3>& p, double radius) {
  if (p.size() < 3) return 0;
  Vec3 n = Vec3::Zero();
  for (size_t k = 2; k < p.size(); ++k) n += (p[k - 1] - p[0]).cross(p[k] - p[0]);
  if (std::abs(n.z()) <= 1e-9 * n.norm()) return 0;  // upright: no more than 1e-9 of its area
  std::vector<Vec2> polygon;
  for (const Vec3& c : p) polygon.push_back(plan(c));
  const DiscRegion d = disc_within(polygon, radius, 0, radius);
  const Vec2 slope(-n.x() / n.z(), -n.y() / n.z());
  return (p[0].z() - slope.dot(polygon[0])) * d.area + slope.dot(d.first);
}

}  // namespace

MeasuredRegion box_region(const Vec3& low, const Vec3& high) {
  return checked({plan(low), plan(high), low.z(), high.z(), 0});
}

MeasuredRegion cylinder_region(const Vec2& centre, double radius, double low_z, double high_z) {
  const Vec2 reach = Vec2::Constant(radius);
  return checked({centre - reach, centre + reach, low_z, high_z, radius});
}

MeasuredRegion layer_of(const MeasuredRegion& region, double low_z, double high_z) {
  MeasuredRegion r = region;
  r.low_z = std::max(low_z, r.low_z), r.high_z = std::min(high_z, r.high_z);
  return checked(r);
}

double volume(const MeasuredRegion& r) {
  const double area = r.radius > 0 ? M_PI * r.radius * r.radius : (r.high - r.low).prod();
  return area * (r.high_z - r.low_z);
}

bool contains(const MeasuredRegion& r, const Vec3& p) {
  if (p.z() < r.low_z || p.z() >= r.high_z) return false;
  if (r.radius > 0) return (plan(p) - middle(r)).norm() < r.radius;
  return p.x() >= r.low.x() && p.x() < r.high.x() && p.y() >= r.low.y() && p.y() < r.high.y();
}

Inside where(const MeasuredRegion& r, const Vec3& c, double radius) {
  double depth = std::min(c.z() - r.low_z, r.high_z - c.z());  // of the centre; < 0 outside
  if (r.radius > 0)
    depth = std::min(depth, r.radius - (plan(c) - middle(r)).norm());
  else
    for (int k = 0; k < 2; ++k) depth = std::min({depth, c[k] - r.low[k], r.high[k] - c[k]});
  return depth >= radius ? Inside::all : depth <= -radius ? Inside::no : Inside::cut;
}

double volume_inside(const std::vector<Vec3>& vertices, const std::vector<std::vector<int>>& faces,
                     const MeasuredRegion& r) {
  // Heights count from low_z, so that what lies below adds nothing.
  const Vec2 m = middle(r);
  const Vec3 origin(m.x(), m.y(), r.low_z);
  const Vec2 half = 0.5 * (r.high - r.low);
  const double height = r.high_z - r.low_z;
  std::vector<Vec3> above, part, work;
  const auto under = [&](std::vector<Vec3>& polygon) {
    if (r.radius > 0) return under_polygon_in_disc(polygon, r.radius);
    for (int k = 0; k < 2; ++k) {
      clip(polygon, k, 1, half[k], work);
      clip(work, k, -1, -half[k], polygon);
    }
    return under_polygon(polygon);
  };
  double sum = 0;
  for (const auto& face : faces) {
    work.clear();
    for (int v : face) work.push_back(vertices[v] - origin);
    clip(work, 2, -1, 0, above);
    clip(above, 2, 1, height, part);
    sum += under(part);
    const bool higher =
        std::any_of(above.begin(), above.end(), [&](const Vec3& p) { return p.z() > height; });
    if (!higher) continue;
    clip(above, 2, -1, height, part);
    for (Vec3& p : part) p.z() = height;
    sum += under(part);
  }
  return sum;
}

double volume_inside(const std::vector<Sphere>& spheres, const MeasuredRegion& r, int slices) {
  if (slices < 1) throw InputError("clump: at least one slice is needed");
  double least = std::numeric_limits<double>::infinity(), low = least, high = -least;
  for (const Sphere& s : spheres) {
    least = std::min(least, s.radius);
    low = std::min(low, s.centre.z() - s.radius), high = std::max(high, s.centre.z() + s.radius);
  }
  low = std::max(low, r.low_z), high = std::min(high, r.high_z);
  if (!(low < high)) return 0;
  const long n = std::max(1l, std::lround((high - low) / (2 * least) * slices));
  const double thickness = (high - low) / double(n);
  double volume = 0;
  for (long k = 0; k < n; ++k) {
    const std::vector<Disc> discs = slice(spheres, low + (double(k) + 0.5) * thickness);
    volume += thickness * (r.radius > 0 ? union_area_in_disc(discs, middle(r), r.radius)
                                        : union_area_in_rectangle(discs, r.low, r.high));
  }
  return volume;
}

}  // namespace trackbed::dem
