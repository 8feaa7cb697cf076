// The contact surface of a body.
#pragma once
#include <string>
#include <vector>

#include "fem/discretisation.h"

namespace trackbed::fem {

struct ContactSurface {
  SurfaceMesh mesh;
  std::vector<int> node;  ///< node of the body of each surface node
};

/// Quads of the named boundaries (each face of order 2 as four), nodes in order of appearance.
/// \throws InputError for an unknown boundary.
ContactSurface contact_surface(const Discretisation&, const Unknowns&, const std::string& body,
                               const std::vector<std::string>& boundaries);

/// Fills `edges` from quads and images.
void mark_edges(SurfaceMesh&);

}  // namespace trackbed::fem
