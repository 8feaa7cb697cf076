// The largest stable time step of a coupled world, from its contacts as they are.
#pragma once
#include "coupling/world.h"
#include "dem/motion/time_step.h"

namespace trackbed::coupling {

/// 2/omega [s], or less where an exchange takes several steps: grains by dem::measured_limit, their
/// contacts with deforming surfaces by the same bound (normal, tangential, tilt; the surface may
/// give way) added (omega^2 add up at most), and the surface nodes with the contacts that press on
/// them,
///   omega^2 <= 2 sum k / m_node.
/// Structures set a limit of their own only where the schedule wants them explicit
/// (schedule_limit). With n grain steps
/// per exchange the surface's omega must also allow the exchange: n dt <= 2/omega (two masses are
/// damped up to n omega dt = 2.2 and grow beyond). Exchange with a predicted surface grows by 8e-8
/// a step at omega dt = 0.1 and 5e-5 at 0.5.
dem::TimeStepLimit measured_limit(const World&, int threads);

}  // namespace trackbed::coupling
