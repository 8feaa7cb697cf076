// Sieve curves: percent passing by mass at each sieve, with the bands of the standards.
#pragma once
#include <string>
#include <vector>

namespace trackbed::dem {

/// Sieve edges [m] ascending; percent by mass passing each. Class 0 holds the grains below the
/// first sieve, class j those between sieve j-1 and j, the last class those above the last sieve.
struct SieveCurve {
  std::string name = "user";
  std::string source;           ///< where the numbers come from
  bool checked = true;          ///< false: quoted from memory of the standard, not from its text
  std::string compared;         ///< of an unchecked one: which limits agree with a second source
  std::vector<double> sieve;    ///< [m]
  std::vector<double> passing;  ///< target [%]; of a standard: the middle of its band
  std::vector<double> band_min, band_max;  ///< [%]; empty when there is no band
  /// Sizes of the two open classes end here [m]. 0: the next standard sieve below the first, above
  /// the last (the 5 % above 63 mm of Shao's wide grading end at 80 mm).
  double bottom = 0, top = 0;
};

/// Throws InputError naming sieve and value: no sieves, lengths that differ, sieves not positive
/// and ascending, passing outside 0 … 100 or decreasing, band that does not hold the target, ends
/// inside the sieves.
void validate(const SieveCurve&);

/// A curve of one's own, validated.
SieveCurve make_curve(const std::vector<double>& sieve, const std::vector<double>& passing);

/// Names known to named_curve: shao2017_large …, tbt2140_special …, en13450_a …, arema_4a ….
std::vector<std::string> curve_names();
/// Throws InputError naming the nearest curve when there is no such name.
SieveCurve named_curve(const std::string& name);

/// Size range (low, high] [m] and share of the mass [%] of each of the sieve.size()+1 classes.
struct SieveClass {
  double low = 0, high = 0, percent = 0;
};
std::vector<SieveClass> sieve_classes(const SieveCurve&);

/// Percent of the volume that passes each sieve (size <= sieve).
std::vector<double> passing_percent(const std::vector<double>& sizes,
                                    const std::vector<double>& volumes,
                                    const std::vector<double>& sieves);

/// Index of the first sieve at which `passing` [%] leaves the band by more than `slack` [%]; -1:
/// none.
int outside_band(const SieveCurve&, const std::vector<double>& passing, double slack = 1e-9);

/// The standard sieve next above / below a size [m], at least a tenth away (ISO 3310 sizes used for
/// ballast and gravel).
double next_sieve_above(double size);
double next_sieve_below(double size);

/// V_d = (rho_bulk / rho_grain) V_box, the solids' volume [m3] in a box at a bulk density: Shao
/// 2017 (14), (15). Throws InputError unless 0 < rho_bulk <= rho_grain and the box is positive.
double solid_volume(double box_volume, double bulk_density, double grain_density);

}  // namespace trackbed::dem
