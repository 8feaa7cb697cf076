// Gradation draw: grains from a library of shapes so that their sieve curve is a given one.
// Class by class as Shao 2017 (steps 1-5), with the counts taken from volumes, not from the paper's
// mass fractions.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/grading/curve.h"
#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

struct DrawParameters {
  double volume = 0;  ///< of all grains together, solid [m3]
  std::uint64_t seed = 1;
  double tolerance = 1;  ///< of each class, in percent of the total volume
  /// true: a shape is scaled to a size inside its class (mass spread evenly over the class, as a
  /// straight piece of the sieve curve says). false: shapes are taken in the size they have.
  bool scale = true;
  /// Needles and flakes (GrainForm) in percent of the volume. Both 0: shapes as the library has
  /// them. Otherwise both are met: in every class a needle or flake of the same sieve size stands
  /// in for an ordinary grain as often as the shares ask (Shao replaces grains of a class by
  /// index). Shapes that are both are left out.
  double needle_share = 0, flaky_share = 0;
};

struct DrawnGrain {
  int shape = 0;      ///< index in the library
  double scale = 1;   ///< of the library's shape [-]
  double sieve = 0;   ///< its sieve size [m]
  double volume = 0;  ///< [m3]
};

struct DrawnClass {
  double low = 0, high = 0;                       ///< sizes (low, high] [m]
  double target_volume = 0, achieved_volume = 0;  ///< [m3]
  int count = 0;
};

struct GradationDraw {
  std::vector<DrawnGrain> grains;  ///< shuffled
  std::vector<DrawnClass> classes;
  std::vector<double> achieved_passing;  ///< [%] at the curve's sieves
  double volume = 0;                     ///< of all grains [m3]
  /// Achieved, percent of the volume; counted when a share was asked for, else 0.
  double needle_percent = 0, flaky_percent = 0;
};

/// Shapes are drawn without repetition until the library is used up, then again. Equal seeds draw
/// equal grains. Throws InputError: volume or tolerance not positive, empty library, a shape that
/// is not sized, a class that no shape falls into (scale = false) or whose volume cannot be met
/// within the tolerance (less than half of its smallest grain: ask for more volume); shares that
/// are negative, exceed 100 together, find no such shape in the library or are missed by more than
/// the tolerance.
GradationDraw draw_gradation(const SieveCurve&, const std::vector<GrainShape>& library,
                             const DrawParameters&);

}  // namespace trackbed::dem
