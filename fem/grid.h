// deal.II's side of a body. Internal: included by the few files that work with deal.II.
#pragma once
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/tria.h>

#include <map>
#include <string>

#include "fem/discretisation.h"
#include "fem/elastic_body.h"

namespace trackbed::fem {

/// Cells with boundary ids and material ids (index into the material list), and one scalar degree
/// of freedom a node: its number is the node's number.
struct Grid {
  dealii::Triangulation<3> cells;
  dealii::FE_Q<3> shape;
  dealii::DoFHandler<3> nodes;
  std::map<std::string, int> boundaries;

  explicit Grid(int order) : shape(order), nodes(cells) {}
  ~Grid() { nodes.clear(); }
};

/// Box or file. \throws InputError: sizes, layers, unreadable file, regions, inverted cells.
void make_cells(const ElasticBodyParameters&, Grid&);
void shift(Grid&, const Vec&);

/// Distributes the nodes and lists them.
Discretisation discretise(Grid&);

}  // namespace trackbed::fem
