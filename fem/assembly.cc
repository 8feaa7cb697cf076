#include "fem/assembly.h"

#include "fem/bed_integrals.h"
#include "fem/element.h"

namespace trackbed::fem {
namespace {

std::vector<int> unknowns_of(const Unknowns& unknowns, const int* nodes, int count) {
  std::vector<int> all;
  for (int i = 0; i < count; ++i)
    for (int unknown : unknowns.of_node[nodes[i]]) all.push_back(unknown);
  return all;
}

// Row sums: positive for both orders (27 nodes of order 2: Simpson's weights).
void lump(dealii::FullMatrix<double>& mass) {
  for (unsigned a = 0; a < mass.m(); ++a) {
    double sum = 0;
    for (unsigned b = 0; b < mass.n(); ++b) {
      sum += mass(a, b);
      mass(a, b) = 0;
    }
    mass(a, a) = sum;
  }
}

void add_bed(const ElasticBodyParameters& p, const Bed& bed, const Discretisation& body,
             const Unknowns& unknowns, const std::vector<std::array<double, 3>>& elastic,
             Matrices& matrices, std::vector<double>& dashpots) {
  const int id = check_bed(p, bed, body);
  for (const Face& face : body.faces) {
    if (face.boundary != id) continue;
    const FaceSprings springs = face_springs(bed, body, face, elastic[face.cell]);
    const auto ids = unknowns_of(unknowns, face.nodes.data(), face.count);
    const std::size_t n = ids.size();
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) {
        if (ids[a] < 0 || ids[b] < 0) continue;
        const int place = matrices.pattern.place(ids[a], ids[b]);
        matrices.stiffness[place] += springs.stiffness[n * a + b];
        if (!dashpots.empty()) dashpots[place] += springs.dashpot[n * a + b];
      }
  }
}

}  // namespace

Assembled assemble(const ElasticBodyParameters& p, const Grid& grid, const Discretisation& body,
                   const Unknowns& unknowns, bool lumped_mass) {
  const int n = body.nodes_per_cell, cells = static_cast<int>(body.cell_nodes.size()) / n;
  std::vector<std::vector<int>> groups(cells);
  for (int c = 0; c < cells; ++c) groups[c] = unknowns_of(unknowns, &body.cell_nodes[c * n], n);

  Assembled out;
  Matrices& m = out.matrices;
  m.pattern = make_pattern(unknowns.count, groups);
  m.stiffness.assign(m.pattern.column.size(), 0.);
  m.mass = m.stiffness;
  if (damps(p)) m.damping = m.stiffness;
  out.node_mass.assign(body.nodes(), 0.);

  ElementIntegrals element(p, grid);
  std::vector<std::array<double, 3>> elastic;  // E, ν, ρ of each cell
  int c = 0;
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    element.compute(cell);
    elastic.push_back(element.mean_elastic());
    if (lumped_mass) lump(element.mass);
    const Material& material = p.materials[cell->material_id()];
    const std::vector<int>& ids = groups[c];
    for (int a = 0; a < 3 * n; ++a) {
      if (ids[a] < 0) continue;
      for (int b = 0; b < 3 * n; ++b) {
        if (ids[b] < 0) continue;
        const int place = m.pattern.place(ids[a], ids[b]);
        const double mass = a % 3 == b % 3 ? element.mass(a / 3, b / 3) : 0.;
        m.stiffness[place] += element.stiffness(a, b);
        m.mass[place] += mass;
        if (!m.damping.empty())
          m.damping[place] +=
              material.rayleigh_mass * mass + material.rayleigh_stiffness * element.stiffness(a, b);
      }
    }
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) out.node_mass[body.cell_nodes[c * n + a]] += element.mass(a, b);
    ++c;
  }
  std::vector<double> dashpots(has_dashpots(p) ? m.pattern.column.size() : 0, 0.);
  for (const Bed& bed : p.beds) add_bed(p, bed, body, unknowns, elastic, m, dashpots);
  for (int row = 0; !dashpots.empty() && row < unknowns.count; ++row)
    for (int e = m.pattern.start[row]; e < m.pattern.start[row + 1]; ++e)
      if (dashpots[e] != 0) {
        m.damping[e] += dashpots[e];
        out.dashpots.push_back({row, m.pattern.column[e], dashpots[e]});
      }
  if (lumped_mass)
    for (int i = 0; i < unknowns.count; ++i) m.lumped.push_back(m.mass[m.pattern.place(i, i)]);
  return out;
}

std::vector<std::array<double, 6>> cell_stress(const ElasticBodyParameters& p, const Grid& grid,
                                               const Discretisation& body,
                                               const std::vector<Vec>& displacement) {
  std::vector<std::array<double, 6>> stress;
  ElementIntegrals element(p, grid);
  const int n = body.nodes_per_cell;
  std::vector<Vec> local(n);
  int c = 0;
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    for (int a = 0; a < n; ++a) local[a] = displacement[body.cell_nodes[c * n + a]];
    stress.push_back(element.centre_stress(cell, local));
    ++c;
  }
  return stress;
}

}  // namespace trackbed::fem
