#include "dem/contact/pressure.h"

#include <algorithm>
#include <limits>

namespace trackbed::dem {
namespace {

struct Point {
  double x, y, z;
};

double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point minus(const Vec3& a, const Vec3& b) { return {a.x() - b.x(), a.y() - b.y(), a.z() - b.z()}; }
Vec3 vector(const Point& p) { return {p.x, p.y, p.z}; }

// A corner of a triangle relative to c, and Q times it.
struct Corner {
  Point y, Qy;
  double q;  ///< y^T Q y
};

Corner corner(const Vec3& p, const Vec3& c, const Mat3& Q) {
  Corner r;
  r.y = minus(p, c);
  r.Qy = {Q(0, 0) * r.y.x + Q(0, 1) * r.y.y + Q(0, 2) * r.y.z,
          Q(1, 0) * r.y.x + Q(1, 1) * r.y.y + Q(1, 2) * r.y.z,
          Q(2, 0) * r.y.x + Q(2, 1) * r.y.y + Q(2, 2) * r.y.z};
  r.q = dot(r.y, r.Qy);
  return r;
}

// Over one triangle: vector area, mean pressure and mean of p y.
struct Means {
  Point area, py;
  double p;
};

Means means(const Corner& a, const Corner& b, const Corner& c, double p0) {
  Means m;
  const Point u = {b.y.x - a.y.x, b.y.y - a.y.y, b.y.z - a.y.z};
  const Point v = {c.y.x - a.y.x, c.y.y - a.y.y, c.y.z - a.y.z};
  m.area = {0.5 * (u.y * v.z - u.z * v.y), 0.5 * (u.z * v.x - u.x * v.z),
            0.5 * (u.x * v.y - u.y * v.x)};
  const double ab = dot(a.y, b.Qy), bc = dot(b.y, c.Qy), ca = dot(c.y, a.Qy);
  const double all = a.q + b.q + c.q + ab + bc + ca;
  m.p = p0 + all / 6;
  // q_aa/10 + (2 ab + 2 ac + bb + cc + bc)/30 = (all + 2 aa + ab + ac)/30
  const double wa = p0 / 3 + (all + 2 * a.q + ab + ca) / 30;
  const double wb = p0 / 3 + (all + 2 * b.q + ab + bc) / 30;
  const double wc = p0 / 3 + (all + 2 * c.q + bc + ca) / 30;
  m.py = {wa * a.y.x + wb * b.y.x + wc * c.y.x, wa * a.y.y + wb * b.y.y + wc * c.y.y,
          wa * a.y.z + wb * b.y.z + wc * c.y.z};
  return m;
}

// f(means) for the triangles of a fan of n corners.
template <class F>
void for_each_triangle(const Vec3* p, int n, const OverlapShape& s, const NormalResponse& r,
                       F&& f) {
  const Corner first = corner(p[0], s.centroid, r.Q);
  Corner last = corner(p[1], s.centroid, r.Q);
  for (int i = 2; i < n; ++i) {
    const Corner next = corner(p[i], s.centroid, r.Q);
    f(first, last, next, means(first, last, next, r.p0));
    last = next;
  }
}

struct Sums {
  double on_x, on_y, on_z, fx = 0, fy = 0, fz = 0, mx = 0, my = 0, mz = 0;
  explicit Sums(const Vec3& on) : on_x(on.x()), on_y(on.y()), on_z(on.z()) {}

  void operator()(const Corner&, const Corner&, const Corner&, const Means& m) {
    const double ax = on_x * m.area.x, ay = on_y * m.area.y, az = on_z * m.area.z;
    fx += m.p * ax, fy += m.p * ay, fz += m.p * az;
    mx += m.py.y * az - m.py.z * ay;
    my += m.py.z * ax - m.py.x * az;
    mz += m.py.x * ay - m.py.y * ax;
  }
  PressureForce force() const { return {Vec3(fx, fy, fz), Vec3(mx, my, mz)}; }
};

}  // namespace

OverlapShape make_shape(const OverlapMoments& m, const OverlapWorkspace& work) {
  OverlapShape s;
  const double inverse = m.volume > 0 ? 1 / m.volume : 0;
  const double x = m.first.x() * inverse, y = m.first.y() * inverse, z = m.first.z() * inverse;
  s.volume = m.volume;
  s.centroid = Vec3(m.about.x() + x, m.about.y() + y, m.about.z() + z);
  const double xy = m.second(0, 1) - m.first.x() * y, xz = m.second(0, 2) - m.first.x() * z,
               yz = m.second(1, 2) - m.first.y() * z;
  s.second_moment << m.second(0, 0) - m.first.x() * x, xy, xz,  //
      xy, m.second(1, 1) - m.first.y() * y, yz,                 //
      xz, yz, m.second(2, 2) - m.first.z() * z;
  s.area = Vec3::Zero();
  for (const OverlapPiece& piece : work.a_pieces) s.area += piece.area;
  double high = -std::numeric_limits<double>::infinity(), low = -high;
  for (const Vec3& p : work.points) high = std::max(high, p.z()), low = std::min(low, p.z());
  s.depth = high > low ? high - low : 0;
  return s;
}

PressureForce integrate_pressure(const OverlapWorkspace& work,
                                 const std::vector<OverlapPiece>& pieces, const OverlapShape& s,
                                 const NormalResponse& r) {
  Sums sums(r.acts_on);
  for (const OverlapPiece& piece : pieces)
    for_each_triangle(work.points.data() + piece.first, piece.count, s, r, sums);
  return sums.force();
}

PressureForce integrate_pressure(const Vec3* corner, int n, const OverlapShape& s,
                                 const NormalResponse& r) {
  Sums sums(r.acts_on);
  for_each_triangle(corner, n, s, r, sums);
  return sums.force();
}

PiecePressure integrate_pressure(const OverlapWorkspace& work, const OverlapPiece& piece,
                                 const OverlapShape& s, const NormalResponse& r) {
  PiecePressure total;
  total.area = piece.area.norm();
  if (!(total.area > 0)) return {};
  total.normal = piece.area / total.area;
  for_each_triangle(work.points.data() + piece.first, piece.count, s, r,
                    [&](const Corner& a, const Corner& b, const Corner& c, const Means& m) {
                      const double size = vector(m.area).dot(total.normal);
                      total.area_first += (size / 3) * (vector(a.y) + vector(b.y) + vector(c.y));
                      total.zeroth += size * m.p;
                      total.first += size * vector(m.py);
                    });
  return total;
}

NodalForces nodal_pressure(const OverlapWorkspace& work, const OverlapPiece& piece,
                           const OverlapShape& s, const NormalResponse& r, const Vec3 corner[3]) {
  const PiecePressure p = integrate_pressure(work, piece, s, r);
  const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  const double twice2 = normal.squaredNorm();
  NodalForces out;
  for (int i = 0; i < 3; ++i) {
    const Vec3& q = corner[(i + 1) % 3];
    const Vec3 gradient = normal.cross(corner[(i + 2) % 3] - q) / twice2;
    const double at_c = gradient.dot(s.centroid - q);
    out.f[i] = (at_c * p.zeroth + gradient.dot(p.first)) * p.normal.cwiseProduct(r.acts_on);
    out.share[i] = at_c * p.area + gradient.dot(p.area_first);
  }
  return out;
}

}  // namespace trackbed::dem
