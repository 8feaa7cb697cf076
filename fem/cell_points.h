// The quadrature points of cells as plain arrays: gradients, weights, strains.
#pragma once
#include <vector>

#include "fem/discretisation.h"
#include "fem/materials/stress_model.h"

namespace trackbed::fem {

struct Grid;

/// Order 1 with the mean dilatation of a cell (Hughes 1980: no locking when plastic flow keeps the
/// volume), order 2 as it is.
struct CellPoints {
  int cells = 0, nodes = 0, points = 0;  ///< nodes and points of one cell
  std::vector<double> gradient;          ///< of N_a at a point: ((cell, point), a, direction) [1/m]
  std::vector<double> mean;              ///< over the cell: (cell, a, direction); empty for order 2
  std::vector<double> weight;            ///< (cell, point) [m3]
  std::vector<double> depth;             ///< (cell, point), under the highest point [m]
};

/// Of the grid's cells with these numbers, ascending.
CellPoints cell_points(const Grid&, int order, const std::vector<int>& cells);

/// B of a point: strain component c from node a's direction d at 3 (nodes c + a) + d.
void strain_matrix(const CellPoints&, int cell, int point, std::vector<double>& B);

}  // namespace trackbed::fem
