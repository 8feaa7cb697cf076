#include "fem/bending.h"

#include <cmath>

namespace trackbed::fem {

double beam_length_ratio(double bed, double bending_stiffness, double length) {
  return length * std::pow(bed / (4 * bending_stiffness), 0.25);
}

double vesic_bed(double soil_modulus, double poisson, double width, double bending_stiffness) {
  return 0.65 * std::pow(soil_modulus * std::pow(width, 4) / bending_stiffness, 1.0 / 12) *
         soil_modulus / (1 - poisson * poisson);
}

}  // namespace trackbed::fem
