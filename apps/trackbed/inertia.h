// Does a structure's inertia matter to a scene? Decided by the load's frequencies and the
// structure's first mode.
#pragma once
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/scene.h"

namespace trackbed::apps {

/// Frequency [Hz] of the load's highest harmonic that counts: the lowest harmonics up to it carry
/// 99 % of the power of the load's variation over a cycle. A sine: its frequency; a triangle: three
/// times that (96/π⁴ = 98.6 % and a 81st of it more); a table: by its Fourier sums.
double highest_harmonic(const LoadingScene&);

/// Below this share of the first mode a load is slow: the answer of an oscillator without damping
/// is 1/(1 − (f/f₁)²) of the static one, at most 6.7 % more.
inline constexpr double kSlowLoad = 0.25;

/// First natural frequency [Hz] of the subgrade's body, on a coarse mesh (which errs upwards); 0
/// where its model has none: a rigid one, points on springs, a material with history.
double first_mode_of_subgrade(const Scene&);

/// Puts "on" or "off" in the place of Subgrade/Inertia = auto: off where the load is slow. Says why
/// in Scene::decisions. Off, the subgrade is static: K u = f at each exchange. Such a surface obeys
/// forces at once, so that a predicted one grows when contacts are stiffer than a third of it
/// (z² + 2rz − r = 0 with r = k_contact/k_surface); Numerics/Exchange = predicted becomes iterated.
/// What the load does not carry, the rattling of grains, is then answered statically too.
/// \throws InputError where off is asked for and the model, a reduction, an absorbing boundary or
/// another schedule cannot go with it.
void decide_inertia(Scene&, const ParameterValues&);

}  // namespace trackbed::apps
