// Shao, Lian, Yang 2017, Eqs. 24-27: global damping, force -alpha m v and torque -alpha I omega on
// all grains, alpha fitted step by step to how the kinetic energy changes. A pass of its own after
// the step, in place of local damping.
//
//   v <- v exp(-alpha dt), L <- L exp(-alpha dt)     exact for these forces, stable for any alpha
//   R = (energy absorbed in the step)/|change of kinetic energy in the step|
//   alpha <- 1.1 alpha where R < 0.5, else 0.99 alpha (Eq. 27); alpha = 0.1 1/s at the start
//
// Departure: the paper's central differences take the force explicitly.
#pragma once
#include "dem/motion/motion.h"

namespace trackbed::dem {

/// What a checkpoint must hold of it.
struct AdaptiveDamping {
  double alpha = 0.1;   ///< [1/s]
  double kinetic = -1;  ///< after the last step [J]; negative before the first
};

/// Damps all free directions, adapts alpha; returns the energy absorbed [J]. To be called after
/// kick.
double damp(AdaptiveDamping&, Bodies&, const StepContext&);

}  // namespace trackbed::dem
