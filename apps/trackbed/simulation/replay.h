// The pair of bodies, or grain and surface, at which a run went wrong, as a scene of its own, and
// that scene's run: the two alone as they moved, the contact law and the step of the run, no walls,
// no load, no neighbours.
#pragma once
#include <string>

#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

/// One body of such a pair.
struct Offender {
  dem::GrainShape shape;
  int material = 0;
  dem::Vec3 x, v, omega;  ///< [m], [m/s], [rad/s]
  dem::Quat q;
  bool held = false;  ///< goes on as it moves
};

/// Body i as it is in `state`.
Offender offender_of(const Run&, const dem::Bodies& state, int i);

/// Stands in for what a deforming surface is at one of its contacts: a held block, twice as wide
/// as the grain, with a flat face where the contact's point was `ago` [s] before, square to the
/// normal force, moving as the nodes that bear the contact do.
Offender surface_at(const Run&, const coupling::Surface&, int contact, double ago);

/// Writes `folder`/offender.prm (run by `trackbed run`) with offender.csv and its shapes; `who` in
/// words. Returns the name of the scene's file; empty when there is nothing to write: a number that
/// is not finite, a shape that no packing file holds. Throws RunError when a file cannot be
/// written.
std::string write_offender(const Run&, const Stage&, const Offender& a, const Offender& b,
                           const std::string& who, const std::string& folder);

inline bool is_replay(const Scene& s) { return !s.replay.bodies.empty(); }

/// The one stage of such a scene.
Stage replay_stage(const Scene&);

}  // namespace trackbed::apps
