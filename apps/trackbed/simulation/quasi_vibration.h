// Quasi-vibration as a stage of a run: each time the bed has come to rest it is kept in
// FOLDER/path_NN.h5, its porosity noted in FOLDER/friction_path.csv, and dem::next_step says from
// which bed to go on and with what friction.
#pragma once
#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

dem::FrictionPathSettings path_settings(const Scene&);

/// On entering: brings back the bed to go on from and sets the stage's friction. The first time the
/// deposit is noted.
void begin_trial(Run&);

/// Gives the bed back its friction once it is as dense as the trial wants; true: it did.
bool stop_bed(Run&);

/// After the bed has come to rest: notes it. False: the wanted bed is found and in the world.
/// Throws InputError naming file and key when there is none, with the reachable range, or when
/// the bed did not come to rest in Packing/Settle time.
bool trial_follows(Run&);

/// Friction at which the bed that was found came to rest.
double bed_friction(const Run&);

/// Removes the kept beds, once a checkpoint holds the one that was found.
void forget_trials(const Run&);

}  // namespace trackbed::apps
