// The pair of bodies at which a run went wrong, as a scene of its own, and that scene's run: the
// two alone as they moved, the contact law and the step of the run, no walls, no load, no
// neighbours.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// Writes `folder`/offender.prm (run by `trackbed run`) with offender.csv and its shapes: bodies a
/// and b as they are in `state`. Returns the name of the scene's file; empty when there is nothing
/// to write: b < 0, a number that is not finite, a shape that no packing file holds. Throws
/// RunError when a file cannot be written.
std::string write_offender(const Run&, const Stage&, const dem::Bodies& state, int a, int b,
                           const std::string& folder);

inline bool is_replay(const Scene& s) { return !s.replay.bodies.empty(); }

/// The one stage of such a scene.
Stage replay_stage(const Scene&);

}  // namespace trackbed::apps
