// A thick cylinder of nearly incompressible soil under inner pressure, against Lamé's answer.
#pragma once
#include <cmath>
#include <fstream>
#include <string>

#include "fem/elastic_body.h"

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

/// u_r inside over the exact 5.062275e-3; writes its mesh into `file`.
inline double cylinder_ratio(const std::string& file, int order, Element element, int along,
                             int around) {
  ElasticBodyParameters p;
  p.mesh.file = cylinder_mesh(file, along, around);
  p.materials = {{"soil", 1000, 0.4999, 1}};
  p.order = order;
  p.element = element;
  p.supports = {{"x_min", Support::roller},
                {"y_min", Support::roller},
                {"bottom", Support::roller},
                {"top", Support::roller}};
  p.contact = {"inside"};
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
  for (const auto& q : s.quads) {
    Vec a, c;
    for (int d = 0; d < 3; ++d)
      a[d] = s.nodes[q[2]][d] - s.nodes[q[0]][d], c[d] = s.nodes[q[3]][d] - s.nodes[q[1]][d];
    const Vec area{(a[1] * c[2] - a[2] * c[1]) / 2, (a[2] * c[0] - a[0] * c[2]) / 2, 0};
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
  return work / force / 5.062275e-3;
}

}  // namespace trackbed::fem::known
