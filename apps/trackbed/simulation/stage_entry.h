// What a stage changes as it begins.
#pragma once
#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// The scene's laws with the stage's contact modulus and its friction as it stands.
void choose_laws(Run&, const Stage&);

/// Bodies, surfaces and laws of the stage, its first forces, its time step, and its ledger where it
/// keeps one. Throws as choose_step.
void enter_stage(Run&, const Stage&);

}  // namespace trackbed::apps
