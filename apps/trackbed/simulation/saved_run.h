// A run in a file: checkpoints to go on from, and packings to start many runs from.
#pragma once
#include <string>

#include "apps/trackbed/simulation/snapshots.h"
#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// What a checkpoint holds besides the run itself.
struct RunRecords {
  std::vector<int> rows;  ///< of the recorder's files
  SnapshotLog snapshots;
};

/// Writes aside and renames. Throws RunError naming the file.
void save_run(const std::string& file, Run&, const RunRecords&);

/// Reads into a run whose scene, layout and threads are set; builds the structures that were there.
/// Throws InputError naming the file when it is missing, truncated, or from another scene.
RunRecords load_run(const std::string& file, Run&);

/// Bodies and contacts of another moment of the run; its time, and what it knows of itself, go on.
void restore_bed(const std::string& file, Run&);

}  // namespace trackbed::apps
