// Where a grain crosses the level of a surface: how long and thin its flat parts' overlap is, hence
// how well its second moments are known, and the overlap of a plain one in exact arithmetic.
#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/verification/exact_overlap.h"

namespace trackbed::dem::test {

/// A grain's part as it stands to a plane z = 0.
struct OnLevel {
  const PartView& part;
  Mat3 R;
  Vec3 x;
  Vec3 corner(int k, const Vec3& from = Vec3::Zero()) const {
    return R * (Vec3(part.core.x[k], part.core.y[k], part.core.z[k]) - from) + x;
  }
  Vec3 normal(int f) const { return R * Vec3(part.core.nx[f], part.core.ny[f], part.core.nz[f]); }
};

/// Corners of what lies on the level or, of a dilated part, below: of the core's cross-section, or
/// of the prisms' on the faces that look down.
inline std::vector<Vec3> cross_section(const OnLevel& g) {
  const ConvexView& v = g.part.core;
  const double r = g.part.radius;
  std::vector<Vec3> corners;
  for (int f = 0; f < v.faces; ++f) {
    const Vec3 up = r * g.normal(f);
    if (up.z() > -.8 * r) continue;
    for (int k = v.loop_begin[f]; k < v.loop_begin[f + 1]; ++k) {
      const int next = k + 1 < v.loop_begin[f + 1] ? k + 1 : v.loop_begin[f];
      const Vec3 p = g.corner(v.loop[k]) + up, q = g.corner(v.loop[next]) + up;
      if (r > 0 && p.z() < 0) corners.push_back(p);
      if ((p.z() < 0) != (q.z() < 0)) corners.push_back(p + p.z() / (p.z() - q.z()) * (q - p));
    }
  }
  return corners;
}

/// Of a cross-section.
struct Section {
  Mat3 along = Mat3::Identity();  ///< first axis along its length
  double slender = 1;             ///< length over width, squared, as of second moments

  Section(const std::vector<Vec3>& corners) {
    if (corners.empty()) return;
    Mat3 sum = Mat3::Zero();
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : corners) mean += p / double(corners.size());
    for (const Vec3& p : corners) sum += (p - mean) * (p - mean).transpose();
    along = rotation(std::atan2(2 * sum(0, 1), sum(0, 0) - sum(1, 1)) / 2 * Vec3::UnitZ());
    double length = 0, width = 0;
    for (const Vec3& p : corners) {
      const Vec3 own = along.transpose() * (p - mean);
      length += own.x() * own.x(), width += own.y() * own.y();
    }
    if (width > 0) slender = length / width;
  }
};

/// What the laws of plain polyhedra make of the overlap with the half space below the level, its
/// moments from exact arithmetic: the formulas of stored_energy.h and shao2017.h, written anew.
struct ExactAnswer {
  double energy = 0;  ///< of stored_energy [J]
  double force = 0;   ///< of shao2017 [N]
};

/// `on` a point of the cross-section's inside. False: it is none.
inline bool answer_exactly(OnLevel g, const Vec3& on, double modulus, ExactAnswer& out) {
  // From the lowest vertex, so that the planes that meet there do so to the last bit, and along the
  // overlap's length, so that a long one's moments keep their digits.
  const ConvexView& v = g.part.core;
  const Mat3 along = Section(cross_section(g)).along.transpose();
  int lowest = 0;
  for (int k = 1; k < v.vertices; ++k)
    if (g.corner(k).z() < g.corner(lowest).z()) lowest = k;
  const Vec3 low = g.corner(lowest), inside = along * (on - low) / 2;
  const Vec3 from(v.x[lowest], v.y[lowest], v.z[lowest]);
  g.R = along * g.R, g.x.setZero();
  std::vector<Plane> planes;
  for (int f = 0; f < v.faces; ++f) {
    const auto begin = v.loop + v.loop_begin[f], end = v.loop + v.loop_begin[f + 1];
    const bool there = std::find(begin, end, lowest) != end;
    const Vec3 n = g.normal(f);
    planes.emplace_back(n.x(), n.y(), n.z(), there ? 0 : -n.dot(g.corner(*begin, from)));
  }
  planes.emplace_back(0, 0, 1, low.z());
  const Exact e = exact_overlap(planes, inside);
  if (e.volume < 0) return false;
  const Vec3 d = e.second.diagonal().cwiseSqrt().cwiseInverse();
  const Mat3 scaled = d.asDiagonal() * e.second * d.asDiagonal();
  const Mat3 inverse = d.asDiagonal() * scaled.inverse() * d.asDiagonal();
  const double thickness = std::sqrt(12 / (inverse.norm() * e.volume));
  const double k = 2 / (3 * std::sqrt(M_PI)) * modulus;
  out.energy = k * std::sqrt(e.volume) * std::pow(thickness, 1.5);
  out.force = 2 * k * std::sqrt(e.volume * -low.z());
  return true;
}

}  // namespace trackbed::dem::test
