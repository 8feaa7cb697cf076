// What the contact tests share: bodies as they are given, one evaluated contact in world axes,
// random poses.
#pragma once
#include <cmath>
#include <vector>

#include "dem/contact/laws/stored_energy.h"
#include "dem/contact/overlap.h"
#include "dem/contact/pressure.h"
#include "dem/contact/separation.h"
#include "dem/grain/random.h"

namespace trackbed::dem::test {

/// A shape whose body frame is the polyhedron's own.
inline GrainShape as_is(const Polyhedron& body) {
  GrainShape shape;
  shape.body = body;
  for (const Vec3& p : body.vertices) shape.radius = std::max(shape.radius, p.norm());
  return shape;
}

inline Polyhedron scaled(Polyhedron body, double factor) {
  for (Vec3& p : body.vertices) p *= factor;
  return body;
}

inline Mat3 rotation(const Vec3& vector) {
  const double angle = vector.norm();
  if (!(angle > 0)) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

inline Mat3 random_rotation(Random& random) {
  const Vec3 axis = random.direction();
  return rotation(random.uniform(0, M_PI) * axis);
}

/// Hull of `count` random points on the unit sphere (triangles, in general).
inline Polyhedron random_hull(Random& random, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(random.direction());
  return convex_hull(points);
}

/// One contact; vectors in world axes, torques about each body's origin.
struct Contact {
  bool touching = false;
  double volume = 0, energy = 0, depth = 0, stiffness = 0;
  Vec3 centroid = Vec3::Zero(), area = Vec3::Zero();
  Vec3 force_a = Vec3::Zero(), torque_a = Vec3::Zero();
  Vec3 force_b = Vec3::Zero(), torque_b = Vec3::Zero();  ///< from b's own pieces
  OverlapShape shape;                                    ///< frame axes
  ContactFrame frame;
};

template <class Law>
Contact evaluate(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                 const Vec3& axis, const Law& law, const PairMaterial& material,
                 OverlapWorkspace& work) {
  Contact c;
  work.clear();
  OverlapMoments moments;
  c.frame = contact_frame(a, pa, b, pb, axis);
  c.touching = overlap(a, pa, b, pb, c.frame, work, moments);
  if (!c.touching) return c;
  const Mat3& axes = c.frame.axes;
  c.shape = make_shape(moments, work);
  const NormalResponse response = law(c.shape, material);
  const PressureForce fa = integrate_pressure(work, work.a_pieces, c.shape, response);
  const PressureForce fb = integrate_pressure(work, work.b_pieces, c.shape, response);
  c.volume = c.shape.volume, c.energy = response.energy, c.depth = c.shape.depth;
  c.stiffness = response.stiffness;
  c.centroid = c.frame.origin + axes * c.shape.centroid;
  c.area = axes * c.shape.area;
  c.force_a = -(axes * fa.force), c.force_b = -(axes * fb.force);
  c.torque_a = (c.centroid - pa.x).cross(c.force_a) - axes * fa.moment;
  c.torque_b = (c.centroid - pb.x).cross(c.force_b) - axes * fb.moment;
  return c;
}

inline PairMaterial material(double modulus) {
  PairMaterial m;
  m.modulus = modulus;
  return m;
}

inline Contact evaluate(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                        const Vec3& axis) {
  OverlapWorkspace work;
  return evaluate(a, pa, b, pb, axis, StoredEnergyLaw(), material(1), work);
}

/// b moved along a random direction until it overlaps a by `share` of a's size.
inline Pose touching_pose(Random& random, const ConvexView& a, const Pose& pa, const ConvexView& b,
                          double share) {
  Pose pb{random_rotation(random), Vec3::Zero()};
  const Vec3 direction = random.direction();
  double near = 0, far = 1.01 * (a.radius + b.radius);
  Vec3 axis = direction;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far);
    pb.x = pa.x + middle * direction;
    (separating_axis(a, pa, b, pb, axis) > 0 ? far : near) = middle;
  }
  pb.x = pa.x + (near - share * a.radius) * direction;
  return pb;
}

}  // namespace trackbed::dem::test
