// A whole run of a scene into a folder: packing (made or taken from the store), then loading.
#pragma once
#include <string>

#include "apps/trackbed/progress.h"
#include "apps/trackbed/scene.h"
#include "apps/trackbed/simulation/run_stages.h"

namespace trackbed::apps {

struct SimulationOptions {
  std::string folder;   ///< exists and is locked by the caller
  int threads = 1;      ///< 0 = all cores
  bool resume = false;  ///< from folder/checkpoint.h5
  bool packing_only = false;
};

/// Writes all files of a run but the report (apps/trackbed/output_folder.cc lists them). Throws as
/// run_stages.
Ending simulate(const Scene&, const SimulationOptions&, Progress&);

}  // namespace trackbed::apps
