// A body's fields as VTU.
#pragma once
#include <string>
#include <vector>

#include "fem/discretisation.h"
#include "fem/elastic_body.h"

namespace trackbed::fem {

struct Grid;

/// Nodal displacement [m] and velocity [m/s], a cell's mean stresses [Pa] and material.
void write_fields(const std::string& file, const ElasticBodyParameters&, const Grid&,
                  const Discretisation&, const std::vector<Vec>& displacement,
                  const std::vector<Vec>& velocity);

/// The same with given stresses xx, yy, zz, yz, xz, xy of the cells.
void write_fields(const std::string& file, const ElasticBodyParameters&, const Grid&,
                  const Discretisation&, const std::vector<Vec>& displacement,
                  const std::vector<Vec>& velocity,
                  const std::vector<std::array<double, 6>>& stress);

/// Displacement at a point, by the cell it lies in. \throws InputError outside.
Vec field_at(const ElasticBodyParameters&, const Grid&, const std::vector<Vec>& displacement,
             const Vec& point);

}  // namespace trackbed::fem
