#include "coupling/edit.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/gather.h"

namespace trackbed::coupling {
namespace {

void gather_bodies(dem::Bodies& b, const std::vector<int>& order) {
  gather(b.x, order), gather(b.q, order), gather(b.R, order), gather(b.v, order);
  gather(b.L, order), gather(b.omega, order), gather(b.turn, order);
  gather(b.force, order), gather(b.torque, order), gather(b.applied_force, order);
  gather(b.mass, order), gather(b.inertia, order), gather(b.shape, order);
  gather(b.material, order), gather(b.freedom, order);
}

// The two parts may stand in either order, then a < b.
bool symmetric(const World& w, int p) {
  const dem::Pairs& k = w.pairs;
  return w.shapes.part(w.bodies.shape[k.a[p]], k.part_a[p]).kind ==
         w.shapes.part(w.bodies.shape[k.b[p]], k.part_b[p]).kind;
}

// The same pair seen from its other body.
void turn_pair(dem::Pairs& pairs, int p) {
  std::swap(pairs.a[p], pairs.b[p]);
  std::swap(pairs.part_a[p], pairs.part_b[p]);
  std::swap(pairs.arm_a[p], pairs.arm_b[p]);
  for (auto* v : {&pairs.axis, &pairs.friction, &pairs.force, &pairs.couple}) (*v)[p] = -(*v)[p];
  // Of the overlap's feature only what does not name both bodies is kept.
  pairs.feature[p] = 0;
  std::swap(pairs.faces_a[p], pairs.faces_b[p]);
}

}  // namespace

void reorder(World& w, const std::vector<int>& order, int grains) {
  std::vector<int> now(w.bodies.size(), -1);
  for (std::size_t k = 0; k < order.size(); ++k) now[order[k]] = static_cast<int>(k);
  gather_bodies(w.bodies, order);
  w.bodies.grains = grains;
  dem::Candidates::State c = w.candidates.state();
  for (auto* travel : {&c.travel, &c.travel_search}) {
    travel->resize(now.size(), 0.0);  // bodies that came since the last search
    gather(*travel, order);
  }
  w.candidates.restore(c);

  for (Surface& s : w.surfaces) dem::renumber_grains(s.contacts, now);

  // Pairs that remain, by their new bodies, in the order the pair list must have.
  dem::Pairs& pairs = w.pairs;
  std::vector<int> kept;
  for (int p = 0; p < pairs.size(); ++p)
    if (now[pairs.a[p]] >= 0 && now[pairs.b[p]] >= 0) kept.push_back(p);
  dem::for_each_array(pairs, [&](const char*, auto& array) { gather(array, kept); });
  for (std::size_t p = 0; p < kept.size(); ++p) {
    pairs.a[p] = now[pairs.a[p]];
    pairs.b[p] = now[pairs.b[p]];
    const int k = static_cast<int>(p);
    if (pairs.a[p] > pairs.b[p] && symmetric(w, k)) turn_pair(pairs, k);
  }
  std::vector<int> sorted(kept.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(),
            [&](int p, int q) { return pairs.key(p) < pairs.key(q); });
  dem::for_each_array(pairs, [&](const char*, auto& array) { gather(array, sorted); });
  pairs.index_bodies(w.bodies.size());
}

void add_grains(World& w, const std::vector<dem::GrainShape>& shapes,
                const std::vector<dem::Vec3>& centre, const std::vector<dem::Quat>& turn,
                double density, int material) {
  const int before = w.bodies.size(), grains = w.bodies.grains;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    dem::add_body(w.bodies, w.shapes.add(shapes[i]), material, density * shapes[i].volume,
                  density * shapes[i].inertia, centre[i], turn[i],
                  dem::kFree);  // behind all others
  std::vector<int> order(w.bodies.size());
  std::iota(order.begin(), order.end(), 0);
  std::rotate(order.begin() + grains, order.begin() + before, order.end());
  reorder(w, order, grains + static_cast<int>(shapes.size()));
}

void remove_bodies(World& w, const std::vector<int>& bodies) {
  std::vector<int> order;
  int grains = 0;
  for (int i = 0; i < w.bodies.size(); ++i)
    if (std::find(bodies.begin(), bodies.end(), i) == bodies.end()) {
      order.push_back(i);
      grains += i < w.bodies.grains;
    }
  reorder(w, order, grains);
}

}  // namespace trackbed::coupling
