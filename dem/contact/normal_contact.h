// What the overlap of two convex bodies answers with, before friction.
#pragma once
#include "dem/contact/pressure.h"

namespace trackbed::dem {

struct NormalContact {
  OverlapShape shape;  ///< frame axes
  NormalResponse response;
  Vec3 force, couple;  ///< on a [N], about the centroid [N m]; world axes
  Vec3 centroid;       ///< [m], from where the frame's origin is measured
};

/// Force, couple and centroid from the law's pressure over one body's pieces: `on_a` is -1 if they
/// are a's, 1 if b's. The pressure over the whole boundary has neither force nor moment: Q and C
/// commute.
inline void set_force(const PressureForce& f, double on_a, const ContactFrame& frame,
                      NormalContact& c) {
  c.force = frame.axes * (on_a * f.force);
  c.couple = frame.axes * (on_a * f.moment);
  c.centroid = frame.axes * c.shape.centroid + frame.origin;
}

}  // namespace trackbed::dem
