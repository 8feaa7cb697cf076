#include "dem/surface/penetration.h"

#include <algorithm>

namespace trackbed::dem {

double penetration(const Bodies& b, const ShapeTable& shapes, const PatchContacts& contacts,
                   int contact) {
  const double size = contacts.normal_force[contact].norm();
  if (!(size > 0)) return 0;
  const int i = contacts.grain[contact];
  const Vec3 inwards = -contacts.normal_force[contact] / size;
  const Vec3 own = b.R[i].transpose() * inwards;
  double reach = 0;
  for (const Vec3& v : shapes.shape(b.shape[i]).body.vertices) reach = std::max(reach, v.dot(own));
  return std::min(contacts.depth[contact], reach - contacts.arm[contact].dot(inwards));
}

}  // namespace trackbed::dem
