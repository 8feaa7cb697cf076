// What a run writes about its bed as it stands: porosity by layers, virtual slices, shapes.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"
#include "dem/packing/measure.h"

namespace trackbed::apps {

/// The scene's region; without one the container from the subgrade to the sleeper's base (to the
/// plate, or to the highest grain, before there is a sleeper).
dem::MeasuredRegion measured_region(const Run&);

/// porosity.csv: layer, z_low_m, z_high_m, porosity, void_ratio, density_kg_per_m3, grains,
/// coordination; layer 0 is the whole region. sections.csv: see dem::to_csv. library.csv: form of
/// the bed's grains, see dem::LibraryReport. Nothing when there are no grains.
void write_measures(const Run&, const std::string& folder);

}  // namespace trackbed::apps
