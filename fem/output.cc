#include "fem/output.h"

#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/numerics/data_out.h>

#include <cmath>
#include <cstdio>
#include <fstream>

#include "base/error.h"
#include "fem/assembly.h"
#include "fem/grid.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

// Written beside the file and renamed, so that a reader never meets half a file.
template <class Write>
void write_aside(const std::string& file, Write&& write) {
  const std::string aside = file + ".part";
  {
    std::ofstream out(aside);
    if (out) write(out);
    out.flush();
    if (!out) throw RunError("'" + file + "' cannot be written");
  }
  if (std::rename(aside.c_str(), file.c_str()) != 0)
    throw RunError("'" + file + "' cannot be written");
}

dealii::Vector<double> on_system(const dealii::DoFHandler<3>& system, const Discretisation& body,
                                 const std::vector<Vec>& field) {
  dealii::Vector<double> values(system.n_dofs());
  std::vector<dealii::types::global_dof_index> ids(system.get_fe().n_dofs_per_cell());
  int c = 0;
  for (const auto& cell : system.active_cell_iterators()) {
    cell->get_dof_indices(ids);
    for (unsigned i = 0; i < ids.size(); ++i) {
      const auto [direction, node] = system.get_fe().system_to_component_index(i);
      values[ids[i]] = field[body.cell_nodes[c * body.nodes_per_cell + node]][direction];
    }
    ++c;
  }
  return values;
}

}  // namespace

void write_fields(const std::string& file, const ElasticBodyParameters& p, const Grid& grid,
                  const Discretisation& body, const std::vector<Vec>& displacement,
                  const std::vector<Vec>& velocity) {
  write_fields(file, p, grid, body, displacement, velocity,
               cell_stress(p, grid, body, displacement));
}

void write_fields(const std::string& file, const ElasticBodyParameters& p, const Grid& grid,
                  const Discretisation& body, const std::vector<Vec>& displacement,
                  const std::vector<Vec>& velocity,
                  const std::vector<std::array<double, 6>>& stress) {
  const dealii::FESystem<3> three(grid.shape, 3);
  dealii::DoFHandler<3> system(grid.cells);
  system.distribute_dofs(three);
  const auto u = on_system(system, body, displacement), v = on_system(system, body, velocity);

  static const char* names[] = {"stress_xx_Pa", "stress_yy_Pa", "stress_zz_Pa",
                                "stress_yz_Pa", "stress_xz_Pa", "stress_xy_Pa"};
  std::vector<dealii::Vector<float>> parts(6, dealii::Vector<float>(stress.size()));
  dealii::Vector<float> mises(stress.size()), material(stress.size());
  for (std::size_t c = 0; c < stress.size(); ++c) {
    const auto& s = stress[c];
    for (int i = 0; i < 6; ++i) parts[i][c] = static_cast<float>(s[i]);
    const double a = s[0] - s[1], b = s[1] - s[2], d = s[2] - s[0];
    mises[c] = static_cast<float>(
        std::sqrt((a * a + b * b + d * d) / 2 + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])));
  }
  unsigned c = 0;
  for (const auto& cell : grid.cells.active_cell_iterators())
    material[c++] = static_cast<float>(cell->material_id());

  using Meaning = dealii::DataComponentInterpretation::DataComponentInterpretation;
  const std::vector<Meaning> vector(
      3, dealii::DataComponentInterpretation::component_is_part_of_vector);
  dealii::DataOut<3> out;
  out.add_data_vector(system, u, std::vector<std::string>(3, "displacement_m"), vector);
  out.add_data_vector(system, v, std::vector<std::string>(3, "velocity_m_per_s"), vector);
  using Type = dealii::DataOut<3>::DataVectorType;
  for (int i = 0; i < 6; ++i) out.add_data_vector(parts[i], names[i], Type::type_cell_data);
  out.add_data_vector(mises, "von_mises_Pa", Type::type_cell_data);
  out.add_data_vector(material, "material", Type::type_cell_data);
  out.build_patches(p.order);
  write_aside(file, [&](std::ostream& stream) { out.write_vtu(stream); });
}

Vec field_at(const ElasticBodyParameters& p, const Grid& grid, const std::vector<Vec>& displacement,
             const Vec& point) {
  const dealii::MappingQ1<3> mapping;
  const dealii::Point<3> x(point[0], point[1], point[2]);
  for (const auto& cell : grid.nodes.active_cell_iterators()) {
    if (!cell->bounding_box().point_inside(x, 1e-10)) continue;
    dealii::Point<3> unit;
    try {
      unit = mapping.transform_real_to_unit_cell(cell, x);
    } catch (const dealii::ExceptionBase&) {
      continue;
    }
    if (!dealii::GeometryInfo<3>::is_inside_unit_cell(unit, 1e-8)) continue;
    std::vector<dealii::types::global_dof_index> ids(grid.shape.n_dofs_per_cell());
    cell->get_dof_indices(ids);
    Vec u{};
    for (unsigned i = 0; i < ids.size(); ++i)
      for (int d = 0; d < 3; ++d) u[d] += grid.shape.shape_value(i, unit) * displacement[ids[i]][d];
    return u;
  }
  throw InputError(
      text(p.name, ": the point (", point[0], ", ", point[1], ", ", point[2], ") lies outside"));
}

void write_pvd(const std::string& file, const std::vector<PvdRecord>& records) {
  write_aside(file, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n";
    out.precision(12);
    for (const PvdRecord& r : records)
      out << "<DataSet timestep=\"" << r.time << "\" part=\"0\" file=\"" << r.file << "\"/>\n";
    out << "</Collection>\n</VTKFile>\n";
  });
}

}  // namespace trackbed::fem
