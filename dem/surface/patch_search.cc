#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "dem/surface/patch_forces.h"
#include "dem/surface/shell_cell.h"

namespace trackbed::dem {
namespace {

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  void include(const Vec3& p) { low = low.cwiseMin(p), high = high.cwiseMax(p); }
  bool meets(const Box& o, const Vec3& shift) const {
    return ((low + shift).array() <= o.high.array()).all() &&
           ((high + shift).array() >= o.low.array()).all();
  }
};

Box grain_box(const Bodies& b, const ShapeTable& shapes, int i, double reach) {
  const ConvexView v = shapes.view(b.shape[i]);
  Box box;
  for (int k = 0; k < v.vertices; ++k) box.include(b.R[i] * Vec3(v.x[k], v.y[k], v.z[k]));
  box.low += b.x[i] - Vec3::Constant(reach);
  box.high += b.x[i] + Vec3::Constant(reach);
  return box;
}

// Images of a cell that may meet the box: none beside itself where nothing is periodic.
template <class F>
void for_each_image(const Box& cell, const Box& grain, const Vec3& period, F&& f) {
  int least[3] = {0, 0, 0}, most[3] = {0, 0, 0};
  for (int k = 0; k < 3; ++k)
    if (period[k] > 0) {
      least[k] = static_cast<int>(std::ceil((grain.low[k] - cell.high[k]) / period[k]));
      most[k] = static_cast<int>(std::floor((grain.high[k] - cell.low[k]) / period[k]));
    }
  for (int i = least[0]; i <= most[0]; ++i)
    for (int j = least[1]; j <= most[1]; ++j) {
      const Vec3 shift(i * period.x(), j * period.y(), 0);
      if (cell.meets(grain, shift)) f(shift);
    }
}

struct Memory {  // of one cell entry of a contact
  Vec3 axis;
  double wake;
};

}  // namespace

void search_patch(const Bodies& b, const ShapeTable& shapes, const SurfacePatch& patch,
                  const StepContext& c, double reach, PatchContacts& contacts) {
  const int cells = 3 * static_cast<int>(patch.triangle.size());
  std::vector<Box> boxes(cells);
  Box whole;
  for (int k = 0; k < cells; ++k) {
    for (const Vec3& p : cell_corners(patch, k)) boxes[k].include(p);
    whole.include(boxes[k].low), whole.include(boxes[k].high);
  }

  PatchContacts old = std::move(contacts);
  contacts = PatchContacts{};
  contacts.node_travel = contacts.searched_at = old.node_travel;
  contacts.workspaces = std::move(old.workspaces);
  std::map<int, int> old_index;
  for (int k = 0; k < old.size(); ++k) old_index[old.grain[k]] = k;

  for (int i = 0; i < b.grains; ++i) {
    const Box grain = grain_box(b, shapes, i, reach);
    bool near = false;
    for_each_image(whole, grain, c.period, [&](const Vec3&) { near = true; });
    if (!near) continue;
    const auto found = old_index.find(i);
    const int before = found == old_index.end() ? -1 : found->second;
    const int first = static_cast<int>(contacts.cell.size());
    for (int k = 0; k < cells; ++k)
      for_each_image(boxes[k], grain, c.period, [&](const Vec3& shift) {
        contacts.cell.push_back(k);
        contacts.shift.push_back(shift);
        Memory memory{Vec3::Zero(), 0};
        if (before >= 0)
          for (int e = old.first[before]; e < old.first[before + 1]; ++e)
            if (old.cell[e] == k && old.shift[e] == shift) memory = {old.axis[e], old.wake[e]};
        contacts.axis.push_back(memory.axis);
        contacts.wake.push_back(memory.wake);
      });
    if (static_cast<int>(contacts.cell.size()) == first) continue;
    contacts.grain.push_back(i);
    contacts.first.push_back(first);
    const auto carry = [&](auto& to, const auto& from, auto fresh) {
      to.push_back(before >= 0 ? from[before] : fresh);
    };
    const Vec3 zero = Vec3::Zero();
    carry(contacts.friction, old.friction, zero);
    carry(contacts.arm, old.arm, zero);
    carry(contacts.friction_stiffness, old.friction_stiffness, 0.0);
    carry(contacts.touching, old.touching, std::uint8_t{0});
    carry(contacts.force, old.force, zero);
    carry(contacts.torque, old.torque, zero);
    carry(contacts.normal_force, old.normal_force, zero);
    carry(contacts.point, old.point, zero);
    carry(contacts.energy, old.energy, 0.0);
    carry(contacts.friction_energy, old.friction_energy, 0.0);
    carry(contacts.friction_loss, old.friction_loss, 0.0);
    carry(contacts.area, old.area, 0.0);
    carry(contacts.depth, old.depth, 0.0);
    carry(contacts.stiffness, old.stiffness, 0.0);
  }
  contacts.first.push_back(static_cast<int>(contacts.cell.size()));
  contacts.nodal.assign(contacts.size(), {});
}

int count_contacts(const PatchContacts& contacts) {
  return static_cast<int>(
      std::count(contacts.touching.begin(), contacts.touching.end(), std::uint8_t{1}));
}

}  // namespace trackbed::dem
