// Clumps of spheres: Jin's filling of a stone, and the shape in its principal frame.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/grain/sphere_union.h"
#include "dem/grain/triangle_solid.h"

namespace trackbed::dem {

/// Jin, Zeng, Ye, Li 2017, section 2.2. Candidates are points inside, each with the largest sphere
/// about it that stays inside. The largest is taken; every candidate whose sphere lies inside the
/// taken one enlarged K times is dropped; and so on down to R_lim. The paper refers to an earlier
/// one for the details; this rule with its spacing gives the paper's counts and volumes for all
/// three of its fillings (README).
struct FillingParameters {
  double least_radius = 0.007;  ///< R_lim [m]
  double space_factor = 1.3;    ///< K [-], >= 1
  double spacing = 0;           ///< of the candidates [m]; 0: V^(1/3) / 13
  std::uint64_t seed = 1;       ///< candidates are a cubic grid, each moved by up to a quarter
  bool at_least_one = false;    ///< a stone too thin for R_lim gets its largest sphere alone
};

/// Largest sphere first; all lie inside the stone. Throws InputError: parameters out of range, a
/// stone that is no solid, R_lim above every candidate (naming the largest radius) unless
/// at_least_one.
std::vector<Sphere> fill_with_spheres(const TriangleSolid&, const FillingParameters&);

/// The clump moved so that its centroid is the origin and its principal axes the coordinate axes,
/// as GrainShape.
struct ClumpShape {
  std::vector<Sphere> spheres;
  double volume = 0;            ///< of the union [m3]
  Vec3 inertia = Vec3::Zero();  ///< principal moments at density 1 [m5], ascending
  double radius = 0;            ///< of the bounding sphere about the centroid [m]
  double sieve_size = 0;        ///< 0: not sized
  Vec3 origin = Vec3::Zero();   ///< pose of this frame in the frame the spheres were given in
  Quat turn = Quat::Identity();
};
ClumpShape make_clump_shape(const std::vector<Sphere>&);

/// As of a GrainShape. Throws InputError when the factor is not positive and finite.
ClumpShape scaled(const ClumpShape&, double factor);

}  // namespace trackbed::dem
