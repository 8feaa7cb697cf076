// Quasi-vibration: any porosity between the loosest and the densest bed by way of the friction
// between grains (Jin, Zeng, Ye, Li 2017). Grains deposited with much friction lie loosely; each
// time their friction is lowered the bed comes to rest a little denser.
//
// Here is the search alone: given the beds that have come to rest so far, from which of them to go
// on and with what friction. Who asks moves the grains and keeps the states. Nothing is remembered
// but the points themselves, so a run can stop and go on anywhere.
#pragma once
#include <string>
#include <vector>

namespace trackbed::dem {

struct FrictionPathSettings {
  /// Grain on grain, falling: the first is that of the deposit, the last that of the densest bed.
  std::vector<double> friction;
  double porosity = -1;          ///< wanted; negative: none
  double relative_density = -1;  ///< wanted, 0 loosest … 1 densest; negative: none
  double tolerance = 1e-3;       ///< of the porosity
  int most_trials = 6;           ///< of frictions between two rungs, and then of stops
};

/// A bed at rest.
struct FrictionPoint {
  int from = -1;  ///< point it was made from; -1: the deposit
  double friction = 0, porosity = 0;
  double stop_at = 0;  ///< its trial's FrictionStep::stop_at
};

struct FrictionStep {
  bool done = false;
  int point = 0;  ///< done: the bed that was wanted. Otherwise the one to go on from
  double friction = 0;
  /// > 0: as soon as the bed is this dense on its way, it gets back the friction of the point it
  /// comes from, and so stops. Friction of the resting bed: that one.
  double stop_at = 0;
};

/// What to do next. First down the rungs, each from the one before: for a porosity only as far as
/// it takes, for a relative density to the end, as the densest bed must be known. Then from the
/// last rung that is too loose, with frictions between its own and the next rung's, by false
/// position kept in the middle four fifths of the interval. Always from that one bed: what a
/// friction leads to depends on where it starts from. Small samples jump over porosities (one grain
/// of fifty that drops is half a percent); then the friction is lowered to the far side of the jump
/// and given back on the way (stop_at), as vibration would be switched off. `points` must hold the
/// deposit at least. Throws InputError: no reachable porosity (with the range), or one that the bed
/// does not stop at (with both sides). The text has no key in front.
FrictionStep next_step(const FrictionPathSettings&, const std::vector<FrictionPoint>& points);

/// Porosity of a relative density D = (e_max - e)/(e_max - e_min) in void ratios e = n/(1-n).
double porosity_at(double relative_density, double loosest, double densest);
double relative_density_at(double porosity, double loosest, double densest);

/// Throws InputError when the frictions do not fall, none is given, or the wanted is out of range.
void validate(const FrictionPathSettings&);

}  // namespace trackbed::dem
