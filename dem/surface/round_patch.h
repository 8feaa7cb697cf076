// Spheres and dilated polyhedra on a deforming surface: one contact per part of a grain and patch,
// at the deepest balls (contact/deepest_balls.h) over all triangles near the part,
//   delta = max over x in the core, y on the surface of  r(x) - |y - x|.
// On coplanar triangles and over the edges between elements delta and its gradient are continuous:
// nothing bumps. U(delta) of the law is the stored energy; y's three nodes take the force by their
// shape functions at y, which is the energy's exact gradient (y may move freely: delta is a
// maximum). Friction and damping act at y too. A sphere's centre may lie below the surface, a
// dilated polyhedron's core may not.
#pragma once
#include "dem/surface/patch_forces.h"

namespace trackbed::dem {

/// Evaluation by the law's name, as make_round_forces; of the contacts from PatchContacts::round
/// on. The evaluation throws RunError naming a grain that is deeper than the patch's shell.
EvaluatePatch make_round_patch_forces(const std::string& law, bool friction);

}  // namespace trackbed::dem
