// Watches a run: the deepest overlap, and what must stop it.
#pragma once
#include <cmath>
#include <string>

#include "base/error.h"
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

/// What a grain's speed may be: `speed` by falling and by what is driven, and `energy` that one
/// contact can give to it besides: speed + sqrt(2 energy / mass).
struct SpeedLimit {
  double speed = HUGE_VAL;  ///< [m/s]
  double energy = 0;        ///< [J]
};

struct StateLimits {
  Region region;
  double overlap = 0.25;  ///< depth over the smaller body's size
  SpeedLimit speed;
};

/// A state that must not go on; `a` is the body at fault, `b` the other of the pair, or what `a`
/// touches hardest (-1: nothing).
struct StateFault : RunError {
  int a, b;
  StateFault(const std::string& text, int body, int other) : RunError(text), a(body), b(other) {}
};

/// Throws StateFault naming step, `when` (in words), body, contact, likely cause and remedy when
///   - a number is not finite, or a grain has left the region;
///   - an overlap is deeper than the limit, or half of a body lies inside another: wholly inside,
///     the gradient of any energy of the overlap is zero and nothing would push it out;
///   - a grain is faster than the limit, or goes further than a tenth of its size in a step.
void check_state(const Bodies&, const ShapeTable&, const Pairs&, const StepContext&, long step,
                 const StateLimits& = {}, const std::string& when = "");

}  // namespace trackbed::dem
