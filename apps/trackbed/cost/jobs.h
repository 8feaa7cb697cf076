// The work list of a study: packings first, each once, then the runs that stand on them.
#pragma once
#include <string>
#include <vector>

#include "apps/trackbed/progress.h"

namespace trackbed::apps {

enum class JobStatus { waiting, done, failed };

/// One run of this program. Its folder keeps `job.csv` (inputs' hash, status, processor time), by
/// which a finished run is recognised.
struct Job {
  std::string folder;            ///< below the study's folder
  std::vector<std::string> set;  ///< overrides of the scene
  std::string inputs;            ///< hash of the resolved scene
  int packing = -1;              ///< index of the job that makes its packing; -1: it is one
  double expected = 0;           ///< [s of one core]
  JobStatus status = JobStatus::waiting;
  double seconds = 0;   ///< of processor time, all attempts
  std::string message;  ///< of a failure
};

struct JobOptions {
  std::string scene;   ///< parameter file
  std::string folder;  ///< of the study
  int at_once = 1;     ///< runs beside each other, one thread each
};

/// Takes over from earlier job.csv files what is finished with the same inputs.
void recognise_finished(std::vector<Job>&, const std::string& folder);

/// Runs what is waiting. False: stopped by a signal, checkpoints are written. A run that fails is
/// marked, and so is what needs its packing; the others go on.
bool run_jobs(std::vector<Job>&, const JobOptions&, Progress&);

}  // namespace trackbed::apps
