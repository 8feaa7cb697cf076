// Tables that a run writes once, at its end or when it is stopped.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// gradation.csv (of coarse grains beside zones see zones.csv), classes.csv, porosity.csv,
/// sections.csv, library.csv, grains.csv, timing.csv, summary.csv, effects.csv, and where the scene
/// has them zones.csv, push.csv and pressure.csv (moment.csv is written at every load peak).
void write_results(const Run&, const std::string& folder);

}  // namespace trackbed::apps
