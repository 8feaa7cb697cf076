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

}  // namespace trackbed::dem
