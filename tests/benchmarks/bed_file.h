// A bed as text, for a peer's code to load: what touches, in world coordinates.
#pragma once
#include <string>

#include "motion_scene.h"

namespace trackbed::dem {

/// Writes `box x y z` (the container, from the origin), then for each grain `grain density parts`
/// and for each part `part radius corners` and its corners: a sphere is one corner with a radius, a
/// polyhedron many without. Lengths in m. Throws RunError when the file cannot be written.
void write_bed(const Scene&, const Vec3& box, double density, const std::string& file);

}  // namespace trackbed::dem
