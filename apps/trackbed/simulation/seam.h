// How near a periodic seam may be.
#pragma once
#include <vector>

#include "apps/trackbed/scene.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::apps {

/// Refuses a period [m], 0 = no seam, that is shorter than three of the largest of these grains,
/// turned in any way, with the skin of the search for candidates (dem/contact/cell_grid.h).
/// \throws InputError
void check_seam(double period, const std::vector<dem::GrainShape>& grains);

/// The same of the grains that a run of the scene would draw: makes its library and draws.
void check_seam_of_drawn(const Scene&);

}  // namespace trackbed::apps
