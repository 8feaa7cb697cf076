// Density, porosity and coordination number of any part of a packing, and its profile by layers.
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "dem/contact/pairs.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"
#include "dem/packing/measured_region.h"

namespace trackbed::dem {

/// What a grain is made of, body frame: convex polyhedra that do not overlap, or the union of
/// spheres.
struct GrainOutline {
  std::vector<Polyhedron> bodies;
  std::vector<Sphere> spheres;
};

/// A grain where it stands.
struct PlacedGrain {
  std::shared_ptr<const GrainOutline> outline;
  Vec3 x = Vec3::Zero();
  Mat3 R = Mat3::Identity();
  double radius = 0;   ///< of a ball about x that holds it [m]
  double volume = 0;   ///< exact, also where the outline is but near (rounded_outline) [m3]
  double density = 0;  ///< [kg/m3]
};

/// The grains among the bodies (not walls, plates, sleepers).
std::vector<PlacedGrain> placed_grains(const Bodies&, const ShapeTable&);

/// Touching pairs of grains: two that touch with several of their parts, which follow each other,
/// are one.
std::vector<std::pair<int, int>> grain_contacts(const Pairs&, int grains);

struct RegionMeasure {
  double volume = 0;        ///< of the region [m3]
  double solid_volume = 0;  ///< of the grains' parts in it; overlaps of contacts count twice [m3]
  double mass = 0;          ///< [kg]
  double density = 0;       ///< bulk: mass / volume [kg/m3]
  double porosity = 0;      ///< 1 - solid_volume / volume [-]
  double void_ratio = 0;    ///< porosity / (1 - porosity); 0 where there is no grain [-]
  int grains = 0;           ///< whose centre lies in the region
  double coordination = 0;  ///< contacts of these grains with any grain, per grain [-]
};

/// Polyhedra exactly, clumps by slices (volume_inside). In a periodic direction (`period` > 0) a
/// grain counts with all its images. Same result for any number of threads.
RegionMeasure measure(const std::vector<PlacedGrain>&,
                      const std::vector<std::pair<int, int>>& contacts, const Vec3& period,
                      const MeasuredRegion&);

/// The region cut into so many layers of equal thickness, from below. Throws InputError: layers <
/// 1.
std::vector<RegionMeasure> measure_layers(const std::vector<PlacedGrain>&,
                                          const std::vector<std::pair<int, int>>& contacts,
                                          const Vec3& period, const MeasuredRegion&, int layers);

/// A dilated grain's outline as a polyhedron: the core plus a ball of many facets. Measured with
/// PlacedGrain::volume = dilated_volume, its parts are right to 0.1 % of the grain for radii up to
/// half of the core's size.
Polyhedron rounded_outline(const Polyhedron& core, double radius);

}  // namespace trackbed::dem
