// The time step of a stage: chosen at its start, watched while it runs.
#pragma once
#include "apps/trackbed/progress.h"
#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

void set_step(Run&, double dt);

/// From where everything stands at a stage's start: its margin times the limit of the stiffest
/// contact to expect, below the limits of exchange schedule and structures, or what Numerics/Time
/// step or its rule says; whole exchanges between the samples of a load cycle. Throws InputError
/// with the step that would do where the scene's own is over the limit.
void choose_step(Run&, const Stage&);

/// Halves the step once the contacts that there are have grown too stiff for it. Throws RunError
/// where the scene fixed the step and it is over the measured limit.
void watch_step(Run&, const Stage&, Progress&);

}  // namespace trackbed::apps
