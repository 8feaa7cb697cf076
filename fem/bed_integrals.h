// What springs and dashpots on a boundary add to stiffness and damping, a face at a time.
#pragma once
#include <array>
#include <vector>

#include "fem/discretisation.h"
#include "fem/elastic_body.h"

namespace trackbed::fem {

/// Square matrices of a face, row and column 3 node + direction [N/m], [N s/m].
struct FaceSprings {
  std::vector<double> stiffness, dashpot;
};

/// `elastic`: E [Pa], ν, ρ [kg/m3] of the cell behind the face, for absorbing boundaries.
FaceSprings face_springs(const Bed&, const Discretisation&, const Face&,
                         const std::array<double, 3>& elastic);

/// Id of the bed's boundary. \throws InputError: no such boundary, a value below 0.
int check_bed(const ElasticBodyParameters&, const Bed&, const Discretisation&);

bool has_dashpots(const ElasticBodyParameters&);
/// Whether dashpots or a material's Rayleigh constants damp.
bool damps(const ElasticBodyParameters&);

}  // namespace trackbed::fem
