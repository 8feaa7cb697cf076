// What the ballast does to the sleeper: pressure under its base and bending moment along it.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// Adds the contact forces on the sleeper's base now to the pressure map of the run.
void keep_pressure(Run&);

/// pressure.csv: x_m, y_m, pressure_Pa, the mean over the load peaks so far, in cells of about
/// 50 mm.
void write_pressure(const Run&, const std::string& file);

/// moment.csv: x_m, deflection_m, moment_Nm along the sleeper, now. The moment follows from
/// equilibrium of the part right of x under its contact forces, weight (that of a block of the
/// sleeper's size and density) and seat loads (inertia
/// neglected), so rigid and elastic sleepers are measured alike; sagging positive.
void write_moment(const Run&, const std::string& file);

/// Downward displacement of the sleeper's base at x [m] against where it was put in.
double deflection_at(const Run&, double x);

}  // namespace trackbed::apps
