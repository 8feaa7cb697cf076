#include "dem/surface/patch_forces.h"

namespace trackbed::dem {

void sum_grain_forces(const PatchContacts& contacts, Bodies& b) {
  for (int i = 0; i < contacts.size(); ++i) {
    if (!contacts.touching[i]) continue;
    b.force[contacts.grain[i]] += contacts.force[i];
    b.torque[contacts.grain[i]] += contacts.torque[i];
  }
}

void sum_node_forces(const PatchContacts& contacts, SurfacePatch& patch) {
  for (Vec3& f : patch.force) f.setZero();
  for (int i = 0; i < contacts.size(); ++i)
    if (contacts.touching[i])
      for (const auto& [node, force] : contacts.nodal[i]) patch.force[patch.master[node]] += force;
}

void sum_patch_forces(const PatchContacts& contacts, Bodies& b, SurfacePatch& patch) {
  sum_grain_forces(contacts, b);
  sum_node_forces(contacts, patch);
}

}  // namespace trackbed::dem
