// Element and boundary integrals of a body.
#pragma once
#include <array>
#include <vector>

#include "fem/discretisation.h"
#include "fem/elastic_body.h"
#include "fem/time_integration.h"

namespace trackbed::fem {

struct Grid;

/// An entry of the damping matrix that belongs to dashpots of a boundary.
struct BoundaryDashpot {
  int row, column;
  double value;  ///< [N s/m]
};

struct Assembled {
  Matrices matrices;
  std::vector<BoundaryDashpot> dashpots;
  std::vector<double> node_mass;  ///< ∫ρ N dV per node [kg]; their sum is the body's mass
};

/// K, M (lumped or consistent) and, if any material or bed damps, C. \throws InputError for a
/// material out of range.
Assembled assemble(const ElasticBodyParameters&, const Grid&, const Discretisation&,
                   const Unknowns&, bool lumped_mass);

/// Stress xx, yy, zz, yz, xz, xy [Pa] at the centre of each cell for nodal displacements.
std::vector<std::array<double, 6>> cell_stress(const ElasticBodyParameters&, const Grid&,
                                               const Discretisation&,
                                               const std::vector<Vec>& displacement);

}  // namespace trackbed::fem
