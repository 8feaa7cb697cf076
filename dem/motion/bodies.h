// The moving state of all bodies: grains first, then rigid bodies (walls, plate, rigid sleeper).
// Structure of arrays; an index never changes during a stage.
#pragma once
#include <cstdint>
#include <vector>

#include "dem/types.h"

namespace trackbed::dem {

/// Bits of Bodies::freedom: a body moves only along the directions whose bit is set.
/// A body with no free direction still has a velocity: it is a prescribed motion.
enum Freedom : std::uint8_t {
  kMoveX = 1,
  kMoveY = 2,
  kMoveZ = 4,
  kTurnX = 8,
  kTurnY = 16,
  kTurnZ = 32,
  kFixed = 0,
  kFree = 63
};

struct Bodies {
  int grains = 0;  ///< bodies [0, grains) are grains, the rest rigid bodies

  std::vector<Vec3> x;       ///< centre of mass [m]
  std::vector<Quat> q;       ///< orientation, body frame -> world, unit
  std::vector<Mat3> R;       ///< the same as a matrix (kept in step with q)
  std::vector<Vec3> v;       ///< velocity [m/s]
  std::vector<Vec3> L;       ///< angular momentum about the centre of mass, world axes [kg m2/s]
  std::vector<Vec3> omega;   ///< angular velocity, world axes [rad/s]
  std::vector<Vec3> turn;    ///< rotation vector of the last step, world axes [rad]
  std::vector<Vec3> force;   ///< contact force of this step [N]
  std::vector<Vec3> torque;  ///< contact torque about the centre of mass, world axes [N m]
  std::vector<Vec3> applied_force;  ///< outer load besides gravity [N], set by who drives the body

  std::vector<double> mass;           ///< [kg]
  std::vector<Vec3> inertia;          ///< principal moments [kg m2]
  std::vector<int> shape;             ///< index into ShapeTable
  std::vector<int> material;          ///< index into the material list
  std::vector<std::uint8_t> freedom;  ///< bits of Freedom

  int size() const { return static_cast<int>(x.size()); }
};

/// Appends a body at rest; returns its index. Rigid bodies come after all grains.
int add_body(Bodies&, int shape, int material, double mass, const Vec3& inertia, const Vec3& x,
             const Quat& q, std::uint8_t freedom);

}  // namespace trackbed::dem
