// A load as weights of nodes: the force on node i is weight_i times the resultant.
#pragma once
#include <utility>
#include <vector>

#include "fem/discretisation.h"
#include "fem/elastic_body.h"

namespace trackbed::fem {

struct LoadPatch {
  std::vector<std::pair<int, double>> weights;  ///< node, share; the shares add up to one
  Vec direction;                                ///< unit
};

/// w_i = ∫N_i dA / A over the boundary, or over the horizontal rectangle on it.
/// \throws InputError: unknown boundary, a rectangle that is empty or sticks out, direction zero.
LoadPatch load_patch(const Discretisation&, const std::string& body, const Load&);

}  // namespace trackbed::fem
