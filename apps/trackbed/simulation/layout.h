// Where things stand in a scene: lengths that several stages need, derived from its parameters.
#pragma once
#include "apps/trackbed/scene.h"
#include "dem/types.h"

namespace trackbed::apps {

struct Layout {
  dem::Vec3 low, high;  ///< inner box of the container, [m]; z from 0, with no lid
  double area;          ///< of the container's cross-section [m2]
  dem::Vec3 period;     ///< [m], 0 where there are walls
  double share;         ///< of the sleeper and its load that is simulated: 1, or 0.5 by symmetry
  double sleeper_low_x, sleeper_high_x, sleeper_low_y, sleeper_high_y;  ///< footprint [m]
  double bed_mass;   ///< of grains poured under the sleeper [kg]
  double fill_mass;  ///< of grains poured beside it [kg]
};

Layout make_layout(const Scene&);

/// Of the sample that is packed: one of Packing/Bays, side by side along the track.
Layout sample_layout(const Scene&);

/// Half width of the ballast's cross-section at height z above the subgrade, with the sleeper's
/// base at `base` [m]; the container's half length where there are no shoulders.
double half_width(const Scene&, double base, double z);

}  // namespace trackbed::apps
