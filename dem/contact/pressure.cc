#include "dem/contact/pressure.h"

#include <algorithm>
#include <limits>

namespace trackbed::dem {
namespace {

// Over one triangle of unit area: mean pressure and mean of p y.
struct Means {
  double p;
  Vec3 py;
};

Means means(const Vec3 (&y)[3], const NormalResponse& r) {
  const Vec3 Q0 = r.Q * y[0], Q1 = r.Q * y[1], Q2 = r.Q * y[2];
  const double q00 = y[0].dot(Q0), q11 = y[1].dot(Q1), q22 = y[2].dot(Q2);
  const double q01 = y[0].dot(Q1), q12 = y[1].dot(Q2), q20 = y[2].dot(Q0);
  Means m;
  m.p = r.p0 + (q00 + q11 + q22 + q01 + q12 + q20) / 6;
  m.py = (r.p0 / 3) * (y[0] + y[1] + y[2]) +
         (q00 / 10 + (2 * q01 + 2 * q20 + q11 + q22 + q12) / 30) * y[0] +
         (q11 / 10 + (2 * q12 + 2 * q01 + q22 + q00 + q20) / 30) * y[1] +
         (q22 / 10 + (2 * q20 + 2 * q12 + q00 + q11 + q01) / 30) * y[2];
  return m;
}

// f(triangle relative to c, its vector area) for the fan of a piece.
template <class F>
void for_each_triangle(const OverlapWorkspace& work, const OverlapPiece& piece, const Vec3& c,
                       F f) {
  const Vec3* p = work.points.data() + piece.first;
  Vec3 y[3] = {p[0] - c, p[1] - c, Vec3::Zero()};
  for (int i = 2; i < piece.count; ++i) {
    y[2] = p[i] - c;
    f(y, Vec3(0.5 * (y[1] - y[0]).cross(y[2] - y[0])));
    y[1] = y[2];
  }
}

}  // namespace

OverlapShape make_shape(const OverlapMoments& m, const OverlapWorkspace& work) {
  OverlapShape s;
  const Vec3 shift = m.volume > 0 ? Vec3(m.first / m.volume) : Vec3(Vec3::Zero());
  s.volume = m.volume;
  s.centroid = m.about + shift;
  s.second_moment = m.second - m.first * shift.transpose();
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
  PressureForce total;
  for (const OverlapPiece& piece : pieces)
    for_each_triangle(work, piece, s.centroid, [&](const Vec3(&y)[3], const Vec3& area) {
      const Means m = means(y, r);
      const Vec3 acts = area.cwiseProduct(r.acts_on);
      total.force += m.p * acts;
      total.moment += m.py.cross(acts);
    });
  return total;
}

PiecePressure integrate_pressure(const OverlapWorkspace& work, const OverlapPiece& piece,
                                 const OverlapShape& s, const NormalResponse& r) {
  PiecePressure total;
  total.area = piece.area.norm();
  if (!(total.area > 0)) return {};
  total.normal = piece.area / total.area;
  for_each_triangle(work, piece, s.centroid, [&](const Vec3(&y)[3], const Vec3& area) {
    const double size = area.dot(total.normal);
    const Means m = means(y, r);
    total.area_first += (size / 3) * (y[0] + y[1] + y[2]);
    total.zeroth += size * m.p;
    total.first += size * m.py;
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
