// Natural frequencies of K x = ω² M x.
#pragma once
#include <vector>

#include "fem/time_integration.h"

namespace trackbed::fem {

/// Lowest `count` frequencies [Hz], ascending, by SLEPc (Krylov–Schur with a shift that is small
/// and negative, so that rigid modes are allowed). \throws RunError if they do not converge.
std::vector<double> lowest_frequencies(const Matrices&, int count);

struct Modes {
  std::vector<double> frequency;           ///< [Hz], ascending
  std::vector<std::vector<double>> shape;  ///< of the unknowns, M-orthonormal to about 1e-10
};

/// The same with their shapes.
Modes lowest_modes(const Matrices&, int count);

/// ω_max [rad/s] of K against the lumped mass (row sums), by power iteration, 2 % safe.
double largest_frequency(const Matrices&);

}  // namespace trackbed::fem
