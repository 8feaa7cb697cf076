// Watches a run: the deepest overlap, and what must stop it.
#pragma once
#include <cmath>

#include "dem/contact/pairs.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/motion.h"

namespace trackbed::dem {

struct Deepest {
  double share = 0;  ///< depth / size of the smaller body, size = cube root of its volume
  int pair = -1;
};
Deepest deepest_overlap(const Bodies&, const ShapeTable&, const Pairs&);

/// Grains are expected inside this box; +-infinity where the scene is open.
struct Region {
  Vec3 low = Vec3::Constant(-HUGE_VAL), high = Vec3::Constant(HUGE_VAL);  ///< [m]
};

/// Throws RunError naming step, body, contact and likely cause when a number is not finite, a grain
/// has left the region, or an overlap is deeper than `deepest` of the smaller body.
void check_state(const Bodies&, const ShapeTable&, const Pairs&, const StepContext&, long step,
                 const Region& = {}, double deepest = 0.25);

}  // namespace trackbed::dem
