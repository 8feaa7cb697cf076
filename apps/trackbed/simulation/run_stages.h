// The loop over stages and steps of a run: time step, monitors, records, snapshots, checkpoints.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/progress.h"
#include "apps/trackbed/simulation/recorder.h"
#include "apps/trackbed/simulation/saved_run.h"

namespace trackbed::apps {

enum class Ending { done, stopped };

/// Runs `stages` from where run.stage stands (index counts from `first_index`, so that packing and
/// loading stages number through). Writes to `folder`; a checkpoint by interval and when a stop is
/// requested. Throws RunError when the run goes wrong; the last checkpoint stays.
Ending run_stages(Run&, const std::vector<Stage>& stages, int first_index,
                  const std::string& folder, Recorder&, SnapshotLog&, Progress&);

}  // namespace trackbed::apps
