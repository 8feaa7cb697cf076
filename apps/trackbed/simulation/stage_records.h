// What a stage records while it runs, and when.
#pragma once
#include <string>

#include "apps/trackbed/simulation/recorder.h"

namespace trackbed::apps {

/// Whether a multiple of `interval` steps was reached with the last `taken` of them.
bool reached(const StageState&, int interval, int taken);

/// Whether a line of history is due after the last `taken` steps.
bool sample_due(const StageState&, int taken, const Scene&);

/// Whether `interval` [s] has passed since the last snapshot; 0: never.
bool snapshot_due(const StageState&, int taken, double interval);

/// The time at which a stage's first step starts: what is zero from here on.
void record_start(Run&, const Stage&, Recorder&);

/// What is recorded at the trough and at the peak of a load cycle. True: the stage is over.
bool record_cycle(Run&, const Stage&, Recorder&, const std::string& folder);

/// Keeps the largest contact force that each grain has had (StageState::grain_force).
void keep_grain_forces(Run&);

/// For the progress bar: how far the stage's own quantity has come.
std::string progress_detail(const Run&);

}  // namespace trackbed::apps
