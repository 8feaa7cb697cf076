// The two sources of cells. Internal.
#pragma once
#include "fem/grid.h"

namespace trackbed::fem {

void make_box(const ElasticBodyParameters&, Grid&);
void read_gmsh(const ElasticBodyParameters&, Grid&);

}  // namespace trackbed::fem
