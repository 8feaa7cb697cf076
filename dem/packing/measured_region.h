// A part of a packing in which density is measured, and how much of a solid lies in it.
#pragma once
#include <vector>

#include "dem/grain/polyhedron.h"
#include "dem/grain/sphere_union.h"

namespace trackbed::dem {

/// A rectangle or a disc in plan, between two heights.
struct MeasuredRegion {
  Vec2 low = Vec2::Zero(),
       high = Vec2::Zero();      ///< of the rectangle, or of the square about a disc
  double low_z = 0, high_z = 0;  ///< [m]
  double radius = 0;             ///< > 0: the disc about the rectangle's middle [m]
};

/// Each throws InputError unless the region has a volume and is finite.
MeasuredRegion box_region(const Vec3& low, const Vec3& high);
/// An upright cylinder.
MeasuredRegion cylinder_region(const Vec2& centre, double radius, double low_z, double high_z);
/// The region's part between two heights.
MeasuredRegion layer_of(const MeasuredRegion&, double low_z, double high_z);

double volume(const MeasuredRegion&);                     ///< [m3]
bool contains(const MeasuredRegion&, const Vec3& point);  ///< borders low <= x < high
/// Does a ball lie wholly inside, wholly outside, or may it be cut?
enum class Inside { no, cut, all };
Inside where(const MeasuredRegion&, const Vec3& centre, double radius);

/// Volume [m3] of a closed polyhedral solid (convex or not, faces planar and convex) inside the
/// region; vertices in world coordinates. Exact, by the divergence theorem: the sum over the faces
/// of the integral over plan of clamp(z, low_z, high_z), signed by the way the face looks. Faces
/// are cut at both heights, then by the rectangle, or with the disc in closed form (disc_region.h).
double volume_inside(const std::vector<Vec3>& vertices, const std::vector<std::vector<int>>& faces,
                     const MeasuredRegion&);

/// Of a union of spheres, by horizontal slices of exact area, so many across the least sphere.
double volume_inside(const std::vector<Sphere>&, const MeasuredRegion&,
                     int slices_per_least_sphere = 40);

}  // namespace trackbed::dem
