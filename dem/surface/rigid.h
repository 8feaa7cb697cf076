// Adding bodies to a scene: grains, and rigid convex bodies that grains touch under the same law
// (container walls as thick boxes, plate, rigid sleeper).
#pragma once
#include <string>
#include <vector>

#include "dem/contact/shape_table.h"
#include "dem/motion/bodies.h"

namespace trackbed::dem {

/// A grain of a shape in the table; `q` turns the shape's principal frame. Grains come before rigid
/// bodies. Returns its index.
int add_grain(Bodies&, const ShapeTable&, int shape, int material, double density, const Vec3& x,
              const Quat& q = Quat::Identity(), std::uint8_t freedom = kFree);

/// A rigid body from a polyhedron whose own frame is turned by `turn` and moved by `place`.
/// `mass` [kg] is spread evenly over it. Adds its shape to the table; returns the body's index.
int add_rigid_body(Bodies&, ShapeTable&, const Polyhedron&, int material, double mass,
                   const Vec3& place, const Quat& turn, std::uint8_t freedom);

/// Box [low, high] as a rigid body.
int add_box(Bodies&, ShapeTable&, const Vec3& low, const Vec3& high, int material, double mass,
            std::uint8_t freedom);

/// Sides of a container.
enum Side : unsigned {
  kLowX = 1,
  kHighX = 2,
  kLowY = 4,
  kHighY = 8,
  kBase = 16,
  kLid = 32,
  kOpenTop = kLowX | kHighX | kLowY | kHighY | kBase
};

/// Walls around the inner space [low, high]: fixed boxes `thickness` thick that reach `thickness`
/// past it on every side, so that corners are closed and, in a periodic direction, no grain meets
/// a wall's end (thickness >= largest grain). Returns their indices in the order of the bits.
std::vector<int> add_container(Bodies&, ShapeTable&, const Vec3& low, const Vec3& high,
                               double thickness, int material, unsigned sides = kOpenTop);

/// Distance of the sides from the axis of a regular prism with the area of a circle [m]: with n
/// sides the wall lies between 1 - pi^2/(6 n^2) and 1 + pi^2/(3 n^2) of the radius from the axis
/// (0.16 % inside, 0.32 % outside for 32), and volumes are exact.
double prism_apothem(double radius, int sides);

/// Upright prism of that kind, its base at z = 0, a side facing along x.
Polyhedron make_round_prism(double radius, double height, int sides);

/// The wall of a round container about the vertical through `centre`, from low to high [m]: fixed
/// blocks that meet in radial planes, one a side of the prism, `thickness` thick. A grain in a
/// corner touches two of them. Throws InputError for fewer than 8 sides.
std::vector<int> add_round_wall(Bodies&, ShapeTable&, const Vec3& centre, double radius, double low,
                                double high, double thickness, int material, int sides);

}  // namespace trackbed::dem
