// Small algebra used everywhere in `dem`. SI units; z is up; positions are relative to the
// scene's origin.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace trackbed::dem {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

}  // namespace trackbed::dem
