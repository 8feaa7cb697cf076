// A thick cylinder of nearly incompressible soil under inner pressure, against Lamé's answer.
#pragma once
#include <cmath>
#include <fstream>
#include <map>
#include <string>

#include "fem/elastic_body.h"
#include "tests/scratch_folder.h"

namespace trackbed::fem::known {

// A quarter of a thick cylinder (radii 3 and 9, pressure 1 inside, plane strain) as a Gmsh file.
inline std::string cylinder_mesh(const std::string& file, int along, int around) {
  std::ofstream out(file);
  const auto id = [&](int r, int t, int z) { return 1 + r + (along + 1) * (t + (around + 1) * z); };
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n2 1 \"inside\"\n2 2 \"x_min\"\n"
         "2 3 \"y_min\"\n2 4 \"bottom\"\n2 5 \"top\"\n$EndPhysicalNames\n$Nodes\n"
      << (along + 1) * (around + 1) * 2 << '\n';
  out.precision(17);
  for (int z = 0; z < 2; ++z)
    for (int t = 0; t <= around; ++t)
      for (int r = 0; r <= along; ++r) {
        const double radius = 3 + 6. * r / along, angle = M_PI / 2 * t / around;
        out << id(r, t, z) << ' ' << (t == around ? 0 : radius * std::cos(angle)) << ' '
            << (t == 0 ? 0 : radius * std::sin(angle)) << ' ' << z << '\n';
      }
  out << "$EndNodes\n$Elements\n"
      << around + 2 * along + 2 * along * around + along * around << '\n';
  int e = 0;
  for (int t = 0; t < around; ++t)
    out << ++e << " 3 2 1 1 " << id(0, t, 0) << ' ' << id(0, t + 1, 0) << ' ' << id(0, t + 1, 1)
        << ' ' << id(0, t, 1) << '\n';
  for (int r = 0; r < along; ++r)
    for (int end : {0, around})
      out << ++e << " 3 2 " << (end ? 2 : 3) << " 1 " << id(r, end, 0) << ' ' << id(r + 1, end, 0)
          << ' ' << id(r + 1, end, 1) << ' ' << id(r, end, 1) << '\n';
  for (int r = 0; r < along; ++r)
    for (int t = 0; t < around; ++t) {
      for (int z : {0, 1})
        out << ++e << " 3 2 " << 4 + z << " 1 " << id(r, t, z) << ' ' << id(r + 1, t, z) << ' '
            << id(r + 1, t + 1, z) << ' ' << id(r, t + 1, z) << '\n';
      out << ++e << " 5 2 9 1";
      for (int z : {0, 1})
        out << ' ' << id(r, t, z) << ' ' << id(r + 1, t, z) << ' ' << id(r + 1, t + 1, z) << ' '
            << id(r, t + 1, z);
      out << '\n';
    }
  out << "$EndElements\n";
  return file;
}

struct Cylinder {
  double ratio;         ///< u_r inside over the exact 5.062275e-3
  double checkerboard;  ///< largest difference of neighbouring cells' mean dilatation over the
                        ///< exact, even one; Q1 only
};

/// Writes its mesh into `file`.
inline Cylinder thick_cylinder(int order, Element element, int along, int around) {
  const ScratchFolder folder;
  ElasticBodyParameters p;
  p.mesh.file = cylinder_mesh(folder.file("cylinder.msh"), along, around);
  p.materials = {{"soil", 1000, 0.4999, 1}};
  p.order = order;
  p.element = element;
  p.supports = {{"x_min", Support::roller},
                {"y_min", Support::roller},
                {"bottom", Support::roller},
                {"top", Support::roller}};
  p.contact = {"inside", "top"};
  ElasticBody b(p);
  const auto& s = b.surface();
  std::vector<Vec> f(s.nodes.size(), Vec{}), u, v;
  // Shares of a flat piece's pressure by the shape functions: even for Q1; of Q2, whose cells'
  // sides are cut in two, a third for a corner and two thirds for a middle, in each direction.
  const auto share = [&](const Vec& x) {
    if (order == 1) return 0.25;
    const bool mid_z = std::abs(x[2] - 0.5) < 0.25, mid_side = std::hypot(x[0], x[1]) < 3 - 1e-9;
    return (mid_z ? 2. : 1.) * (mid_side ? 2. : 1.) / 9;
  };
  for (std::size_t k = 0; k < s.quads.size(); ++k) {
    const auto& q = s.quads[k];
    Vec a, c;
    for (int d = 0; d < 3; ++d)
      a[d] = s.nodes[q[2]][d] - s.nodes[q[0]][d], c[d] = s.nodes[q[3]][d] - s.nodes[q[1]][d];
    const Vec area{(a[1] * c[2] - a[2] * c[1]) / 2, (a[2] * c[0] - a[0] * c[2]) / 2, 0};
    if (std::hypot(area[0], area[1]) < 1e-9) continue;  // of the top
    for (int n : q)  // outwards of the body is inwards of the hole
      for (int d = 0; d < 3; ++d) f[n][d] -= share(s.nodes[n]) * area[d];
  }
  b.solve_static(f);
  b.motion(u, v);
  // Mean radial displacement as the pressure's work has it.
  double work = 0, force = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    work += u[i][0] * f[i][0] + u[i][1] * f[i][1];
    force += std::hypot(f[i][0], f[i][1]);
  }
  // Plane strain: a cell's mean dilatation is the flow through the sides of its top. By Lame it is
  // the same everywhere, 2 (1+nu)(1-2nu)/E p a^2/(b^2-a^2).
  const double exact = 2 * 1.4999 * 0.0002 / 1000 * 9 / 72;
  std::map<std::pair<int, int>, double> dilatation;  // by place along the radius and around
  for (const auto& q : s.quads) {
    double flow = 0, area = 0, x = 0, y = 0;
    for (int k = 0; k < 4; ++k) {
      const int i = q[k], j = q[(k + 1) % 4];
      const Vec &from = s.nodes[i], &to = s.nodes[j];
      flow +=
          0.5 * ((u[i][0] + u[j][0]) * (to[1] - from[1]) - (u[i][1] + u[j][1]) * (to[0] - from[0]));
      area += 0.5 * (from[0] * to[1] - to[0] * from[1]);
      x += from[0] / 4, y += from[1] / 4;
    }
    if (std::abs(area) < 1e-9) continue;  // of the inside
    dilatation[{int((std::hypot(x, y) - 3) / 6 * along), int(std::atan2(y, x) / M_PI_2 * around)}] =
        flow / area;
  }
  double most = 0;
  for (const auto& [at, value] : dilatation)
    for (const auto& other : {std::pair{at.first + 1, at.second}, {at.first, at.second + 1}})
      if (dilatation.count(other))
        most = std::max(most, std::abs(dilatation[other] - value) / exact);
  return {work / force / 5.062275e-3, most};
}

inline double cylinder_ratio(int order, Element element, int along, int around) {
  return thick_cylinder(order, element, along, around).ratio;
}

}  // namespace trackbed::fem::known
