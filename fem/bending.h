// Does a beam's bending matter on its bed?
#pragma once

namespace trackbed::fem {

/// λL of a beam on an elastic bed, λ = (k/(4EI))^(1/4) (Hetényi 1946): beams with λL < π/4 may be
/// taken as rigid, those beyond bend. k [N/m2] per length, EI [N m2], L [m], all > 0.
double beam_length_ratio(double bed, double bending_stiffness, double length);

/// Hetényi's bound of a short beam, π/4.
inline constexpr double kShortBeam = 0.7853981633974483;

/// k of a beam of width b on a half-space (Vesic 1961):
///   k = 0.65 (E_s b⁴/EI)^(1/12) E_s/(1−ν²)  [N/m2 per length]
double vesic_bed(double soil_modulus, double poisson, double width, double bending_stiffness);

}  // namespace trackbed::fem
