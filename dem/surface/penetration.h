// How deep a grain stands in a deforming surface.
#pragma once
#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"
#include "dem/surface/patch_forces.h"

namespace trackbed::dem {

/// How far the grain of a touching contact reaches behind the surface it presses on [m]: its extent
/// from its centre against the normal force, less the way to where it is pressed; at most the
/// overlap's own depth. That depth alone would not do: a thin slice off a grain's side is long.
double penetration(const Bodies&, const ShapeTable&, const PatchContacts&, int contact);

}  // namespace trackbed::dem
