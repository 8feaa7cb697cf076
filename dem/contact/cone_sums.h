// Volume and moments of a polyhedron from its boundary, by cones from a point to triangles.
#pragma once
#include "dem/contact/overlap.h"

namespace trackbed::dem {

/// 6 V, and the first and second moments' raw sums.
struct ConeSums {
  double six = 0, x = 0, y = 0, z = 0;
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  /// A fan of n >= 3 corners, counter-clockwise from outside.
  void add(const Vec3* p, int n, const Vec3& about) {
    const double ax = p[0].x() - about.x(), ay = p[0].y() - about.y(), az = p[0].z() - about.z();
    double bx = p[1].x() - about.x(), by = p[1].y() - about.y(), bz = p[1].z() - about.z();
    for (int i = 2; i < n; ++i) {
      const double cx = p[i].x() - about.x(), cy = p[i].y() - about.y(), cz = p[i].z() - about.z();
      const double ux = bx - ax, uy = by - ay, uz = bz - az;
      const double vx = cx - ax, vy = cy - ay, vz = cz - az;
      const double v =
          ax * (uy * vz - uz * vy) + ay * (uz * vx - ux * vz) + az * (ux * vy - uy * vx);
      const double sx = ax + bx + cx, sy = ay + by + cy, sz = az + bz + cz;
      six += v;
      x += v * sx, y += v * sy, z += v * sz;
      xx += v * (sx * sx + ax * ax + bx * bx + cx * cx);
      yy += v * (sy * sy + ay * ay + by * by + cy * cy);
      zz += v * (sz * sz + az * az + bz * bz + cz * cz);
      xy += v * (sx * sy + ax * ay + bx * by + cx * cy);
      xz += v * (sx * sz + ax * az + bx * bz + cx * cz);
      yz += v * (sy * sz + ay * az + by * bz + cy * cz);
      bx = cx, by = cy, bz = cz;
    }
  }

  /// Adds the moments to those about the same point.
  void add_to(OverlapMoments& moments) const {
    moments.volume += six / 6;
    moments.first += Vec3(x, y, z) / 24;
    Mat3& m = moments.second;
    m(0, 0) += xx / 120, m(1, 1) += yy / 120, m(2, 2) += zz / 120;
    m(0, 1) += xy / 120, m(0, 2) += xz / 120, m(1, 2) += yz / 120;
    m(1, 0) = m(0, 1), m(2, 0) = m(0, 2), m(2, 1) = m(1, 2);
  }
};

}  // namespace trackbed::dem
