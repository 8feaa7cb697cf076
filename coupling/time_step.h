// The largest stable time step of a coupled world, from its contacts as they are.
#pragma once
#include "coupling/world.h"
#include "dem/motion/time_step.h"

namespace trackbed::coupling {

/// 2/omega [s], or less where an exchange takes several steps. Each contact's stiffness is split
/// over its two ends, (x+y)^2 <= 2x^2 + 2y^2, so that omega^2 is at most the largest of
///   - each grain's bound from all its contacts, those with surfaces included
///     (dem::measured_limit: normal, tangential, tilt);
///   - each structure's bound with the other ends as springs on its surface nodes, by the share of
///     force that each takes: a positive pressure over the facets, so that such springs are no
///     softer than the contact. What mass it opposes to them is the structure's affair
///     (fem::Structure::contact_bound): a body of modes or of consistent mass as a whole, others by
///     their lightest node. A predicted surface that a solve then moves elsewhere is allowed a
///     third of the step: two masses grow there by at most 1e-3 a step, at half of it by 5e-3,
///     which a bed of spheres under a sleeper did not bear.
/// Structures set a limit of their own only where the schedule wants them explicit
/// (schedule_limit). With n grain steps per exchange the surface's omega (its contacts alone) must
/// also allow the exchange: n dt <= 2/omega (two masses are damped up to n omega dt = 2.2 and grow
/// beyond). Exchange with a predicted surface grows by 8e-8 a step at omega dt = 0.1 and 5e-5 at
/// 0.5.
dem::TimeStepLimit measured_limit(const World&, int threads);

}  // namespace trackbed::coupling
