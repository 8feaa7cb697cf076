#include "dem/grain/dilated_shape.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "dem/grain/principal_axes.h"
#include "dem/grain/scale_solid.h"

namespace trackbed::dem {

DilatedShape make_dilated_shape(const DilatedPolyhedron& given) {
  const MassProperties p = mass_properties(given);
  DilatedShape shape;
  shape.turn = Quat(principal_axes(p.inertia)).normalized();
  shape.origin = p.centroid;
  shape.body = given;
  const Mat3 back = shape.turn.toRotationMatrix().transpose();
  for (Vec3& v : shape.body.core.vertices) {
    v = (back * (v - p.centroid)).eval();
    shape.radius = std::max(shape.radius, v.norm() + given.radius);
  }
  const MassProperties own = mass_properties(shape.body);
  shape.volume = own.volume;
  shape.inertia = own.inertia.diagonal();
  return shape;
}

DilatedShape scaled(const DilatedShape& shape, double factor) {
  DilatedShape result = shape;
  scale_solid(result, factor, "dilated grain");
  for (Vec3& v : result.body.core.vertices) v *= factor;
  result.body.radius *= factor;
  return result;
}

DilatedShape dilate_within(const GrainShape& sized, double share) {
  if (!(share >= 0 && share < 0.5))
    throw InputError("dilated grain: the radius must be 0 to 0.5 of the sieve size");
  if (!(sized.sieve_size > 0)) throw InputError("dilated grain: the shape is not sized");
  DilatedPolyhedron body{sized.body, share * sized.sieve_size};
  for (Vec3& v : body.core.vertices) v *= 1 - 2 * share;
  DilatedShape shape = make_dilated_shape(body);
  shape.sieve_size = sized.sieve_size;
  return shape;
}

}  // namespace trackbed::dem
