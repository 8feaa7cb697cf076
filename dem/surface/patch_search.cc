#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "base/gather.h"
#include "dem/contact/part_pairs.h"
#include "dem/surface/patch_forces.h"

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

Box part_box(const Bodies& b, const ShapeTable& shapes, int i, int part, double reach) {
  Box box;
  include_part(shapes.part(b.shape[i], part), b.R[i], box.low, box.high);
  box.low += b.x[i] - Vec3::Constant(reach);
  box.high += b.x[i] + Vec3::Constant(reach);
  return box;
}

// Images of a box that may meet the grain's: none beside itself where nothing is periodic.
template <class F>
void for_each_image(const Box& box, const Box& grain, const Vec3& period, F&& f) {
  int least[3] = {0, 0, 0}, most[3] = {0, 0, 0};
  for (int k = 0; k < 3; ++k)
    if (period[k] > 0) {
      least[k] = static_cast<int>(std::ceil((grain.low[k] - box.high[k]) / period[k]));
      most[k] = static_cast<int>(std::floor((grain.high[k] - box.low[k]) / period[k]));
    }
  for (int i = least[0]; i <= most[0]; ++i)
    for (int j = least[1]; j <= most[1]; ++j) {
      const Vec3 shift(i * period.x(), j * period.y(), 0);
      if (box.meets(grain, shift)) f(shift);
    }
}

// Finds the triangles whose part of the shell meets a box: sorted by their low side along the
// patch's longest direction, so that a bisection leaves a strip of them.
class TriangleFinder {
 public:
  explicit TriangleFinder(const SurfacePatch& patch) {
    const int triangles = static_cast<int>(patch.triangle.size());
    for (int t = 0; t < triangles; ++t) {
      Box box;
      for (const int node : patch.triangle[t]) {
        box.include(patch.node[node]);
        box.include(patch.node[node] + patch.inset[node]);
      }
      whole_.include(box.low), whole_.include(box.high);
      triangles_.push_back(box);
    }
    (whole_.high - whole_.low).maxCoeff(&along_);
    for (int t = 0; t < triangles; ++t) {
      const Box& box = triangles_[t];
      sorted_.push_back({box.low[along_], t});
      widest_ = std::max(widest_, box.high[along_] - box.low[along_]);
    }
    std::sort(sorted_.begin(), sorted_.end());
  }

  struct Hit {
    int triangle, image;
    bool operator<(const Hit& o) const {
      return triangle != o.triangle ? triangle < o.triangle : image < o.image;
    }
  };

  /// Triangles that meet the grain's box, in rising order, and the images they are in.
  void find(const Box& grain, const Vec3& period, std::vector<Hit>& hits,
            std::vector<Vec3>& images) const {
    hits.clear();
    images.clear();
    for_each_image(whole_, grain, period, [&](const Vec3& shift) {
      const double low = grain.low[along_] - shift[along_] - widest_,
                   high = grain.high[along_] - shift[along_];
      for (auto s = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(low, -1));
           s != sorted_.end() && s->first <= high; ++s) {
        if (triangles_[s->second].meets(grain, shift))
          hits.push_back({s->second, static_cast<int>(images.size())});
      }
      images.push_back(shift);
    });
    std::sort(hits.begin(), hits.end());
  }

 private:
  std::vector<Box> triangles_;
  Box whole_;
  int along_ = 0;
  double widest_ = 0;
  std::vector<std::pair<double, int>> sorted_;  // low side, triangle
};

// Entry of a triangle's image in a contact of the last search, -1 if it is new.
int find_entry(const PatchContacts& old, int contact, int triangle, const Vec3& shift) {
  if (contact < 0) return -1;
  const auto begin = old.triangle.begin();
  const auto end = begin + old.first[contact + 1];
  for (auto t = std::lower_bound(begin + old.first[contact], end, triangle);
       t != end && *t == triangle; ++t)
    if (old.shift[t - begin] == shift) return static_cast<int>(t - begin);
  return -1;
}

}  // namespace

void search_patch(const Bodies& b, const ShapeTable& shapes, const SurfacePatch& patch,
                  const StepContext& c, double reach, PatchContacts& contacts) {
  const TriangleFinder finder(patch);
  PatchContacts old = std::move(contacts);
  contacts = PatchContacts{};
  contacts.node_travel = contacts.searched_at = old.node_travel;
  contacts.workspaces = std::move(old.workspaces);
  std::map<std::pair<int, int>, int> old_contact;
  for (int k = 0; k < old.size(); ++k) old_contact[{old.grain[k], old.part[k]}] = k;

  std::vector<TriangleFinder::Hit> hits;
  std::vector<Vec3> images;
  const auto search = [&](int i, int part) {
    finder.find(part_box(b, shapes, i, part, reach), c.period, hits, images);
    if (hits.empty()) return;
    const auto found = old_contact.find({i, part});
    const int before = found == old_contact.end() ? -1 : found->second;
    const bool point = shapes.part(b.shape[i], part).kind == Core::point;
    contacts.grain.push_back(i);
    contacts.part.push_back(part);
    contacts.first.push_back(static_cast<int>(contacts.triangle.size()));
    for (const auto& hit : hits) {
      const Vec3& shift = images[hit.image];
      const int entry = find_entry(old, before, hit.triangle, shift);
      contacts.triangle.push_back(hit.triangle);
      contacts.shift.push_back(shift);
      contacts.axis.push_back(entry < 0 ? Vec3(Vec3::Zero()) : old.axis[entry]);
      contacts.wake.push_back(entry < 0 || point ? 0 : old.wake[entry]);
    }
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
    carry(contacts.tilt_stiffness, old.tilt_stiffness, 0.0);
    carry(contacts.viscous, old.viscous, 0.0);
    carry(contacts.viscous_loss, old.viscous_loss, 0.0);
  };
  for (const bool round : {false, true}) {
    for (int i = 0; i < b.grains; ++i)
      for (int part = 0; part < shapes.parts(b.shape[i]); ++part)
        if ((shapes.part(b.shape[i], part).kind != Core::plain) == round) search(i, part);
    if (!round) contacts.round = contacts.size();
  }
  contacts.first.push_back(static_cast<int>(contacts.triangle.size()));
  contacts.nodal.assign(contacts.size(), {});
}

void renumber_grains(PatchContacts& contacts, const std::vector<int>& now) {
  std::vector<int> kept;  // contacts in the order of their grains' new numbers
  for (int k = 0; k < contacts.size(); ++k)
    if (now[contacts.grain[k]] >= 0) kept.push_back(k);
  const auto place = [&](int k) {
    return std::tuple(k >= contacts.round, now[contacts.grain[k]], contacts.part[k]);
  };
  std::sort(kept.begin(), kept.end(), [&](int i, int j) { return place(i) < place(j); });
  const int round = contacts.round;
  contacts.round = static_cast<int>(
      std::count_if(kept.begin(), kept.end(), [round](int k) { return k < round; }));
  std::vector<int> entries, first;
  for (const int k : kept) {
    first.push_back(static_cast<int>(entries.size()));
    for (int e = contacts.first[k]; e < contacts.first[k + 1]; ++e) entries.push_back(e);
  }
  first.push_back(static_cast<int>(entries.size()));
  for_each_triangle_array(contacts, [&](const char*, auto& v) { gather(v, entries); });
  for_each_contact_array(contacts, [&](const char*, auto& v) { gather(v, kept); });
  gather(contacts.nodal, kept);
  contacts.first = first;
  for (int& g : contacts.grain) g = now[g];
}

void find_round(const Bodies& b, const ShapeTable& shapes, PatchContacts& k) {
  k.round = 0;
  while (k.round < k.size() &&
         shapes.part(b.shape[k.grain[k.round]], k.part[k.round]).kind == Core::plain)
    ++k.round;
}

int count_contacts(const PatchContacts& contacts) {
  return static_cast<int>(
      std::count(contacts.touching.begin(), contacts.touching.end(), std::uint8_t{1}));
}

}  // namespace trackbed::dem
