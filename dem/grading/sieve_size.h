// The size of a convex grain: the least square hole it passes, by name of method.
// Methods and their errors: Shao, Lian, Yang 2017; Eliáš 2014 (Powder Technology 264:458).
#pragma once
#include <string>
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::dem {

/// From cheap to exact.
enum class SieveMethod {
  equal_cube,    ///< edge of the cube of equal volume, V^(1/3)
  equal_sphere,  ///< diameter of the sphere of equal volume, (6V/pi)^(1/3)
  elias2014,   ///< least square around the projection along the axis of least inertia, one side of
               ///< it on a side of the projection (64 for a plate 64 x 4 x 100, as Shao reads it)
  shao2017,    ///< least-area shadow along the grain's edges (the paper's rule, which misses the
               ///< true least shadow of about a third of all grains); least-area rectangle p x q
               ///< around it, p >= q; passes a hole s when p <= s or, turned, (p+q)/sqrt2 <= s
  min_shadow,  ///< least-area shadow (along n_i x n_j of all faces), least square around it
  exact,       ///< least square around any shadow; the default
};

const std::vector<std::string>& sieve_method_names();  ///< in the order of the enum
std::string to_string(SieveMethod);
/// Throws InputError naming the nearest method when there is no such name.
SieveMethod parse_sieve_method(const std::string& name);

/// Sieve size [m] of a convex polyhedron. Throws InputError when its volume is not positive.
double sieve_size(const Polyhedron&, SieveMethod = SieveMethod::exact);

/// The exact size with the hole's directions, and what is certain about it.
struct ExactSieveSize {
  double size = 0;         ///< max(w(u), w(v)) [m]: the grain does pass a hole of this edge
  double lower_bound = 0;  ///< it passes no hole smaller than this [m]
  Vec3 u = Vec3::UnitX();  ///< directions of the hole's sides, orthonormal, in the body's frame
  Vec3 v = Vec3::UnitY();
  int evaluations = 0;
};

/// min over orthonormal u, v of max(w(u), w(v)), w(u) = max x.u - min x.u the width of the grain.
/// Branch and bound over u with the least width of the shadow along u as inner problem; stops when
/// size - lower_bound <= tolerance * size. Throws InputError when the volume is not positive.
ExactSieveSize exact_sieve_size(const Polyhedron&, double tolerance = 2e-7);

}  // namespace trackbed::dem
