// What the track gives to its subgrade and takes at its rail seats, at one instant.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// subgrade_pressure.csv: x_m, y_m, pressure_Pa, the grains' vertical forces on the subgrade now,
/// in cells of about 50 mm; subgrade_pressure_profile.csv: x_m, pressure_Pa, its mean over the
/// track's direction y.
void write_subgrade_pressure(const Run&, const std::string& folder);

/// rail_seats.csv: seat, x_m, load_N, displacement_m (downwards, from where the sleeper was put
/// in), rail_displacement_m (the same beyond the rail pad), now.
void write_rail_seats(const Run&, const std::string& file);

}  // namespace trackbed::apps
