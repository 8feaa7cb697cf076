// What stops a run that goes wrong, before a number is no longer finite.
#pragma once
#include "apps/trackbed/simulation/stage.h"
#include "dem/motion/monitor.h"

namespace trackbed::apps {

/// What is known of a stage to judge its grains by. Not part of a checkpoint: results do not depend
/// on it, only when a run that goes wrong is stopped.
struct Watch {
  dem::Bodies before;      ///< at the last look that found nothing
  double before_time = 0;  ///< [s]
  double fall = 0;         ///< height from which a grain may fall [m]
  double driven = 0;  ///< fastest of what moved at the start, plate, sleeper and surfaces [m/s]
  double energy = 0;  ///< largest stored in one contact so far [J]
};

/// A grain too deep in a deforming surface.
struct SurfaceFault : dem::StateFault {
  int surface, contact;  ///< of World::surfaces, of its contacts
  SurfaceFault(const std::string& text, int grain, int its_surface, int its_contact)
      : StateFault(text, grain, -1), surface(its_surface), contact(its_contact) {}
};

/// At a stage's start, or where it goes on after a checkpoint.
Watch start_watch(const Run&);

/// Throws dem::StateFault where dem::check_state does, with Contact/Largest overlap, contacts with
/// deforming surfaces included, and for a grain faster than Numerics/Largest speed. Where that is
/// 0, a grain may be three times as fast as falling from the bed's top, what is driven, and the
/// energy of the strongest contact so far would make it:
///   3 (sqrt(2 g fall) + driven + sqrt(2 energy/m)).
void inspect(const Run&, const Stage&, Watch&);

/// At the end of a load cycle, or of a stage of a test of grains, where the height that the grains
/// gave up counts as work too: dem::StateFault naming the deepest contact when more energy came
/// from nowhere than Numerics/Closure allows.
void check_ledger(const Run&, const Stage&);

}  // namespace trackbed::apps
