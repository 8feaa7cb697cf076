// Tables that a run writes once, at its end or when it is stopped.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// gradation.csv, grains.csv, timing.csv, summary.csv, and after load cycles pressure.csv
/// (moment.csv is written at every load peak). `wall_seconds` of the whole run.
void write_results(const Run&, const std::string& folder, double wall_seconds);

}  // namespace trackbed::apps
