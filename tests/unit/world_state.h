// The whole state of a world: to a file and back, and compared bit by bit with another's.
#pragma once

#include <cstring>
#include <string>

#include "coupling/checkpoint.h"

namespace trackbed::coupling {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Names of what differs, empty if nothing does.
inline std::string differing(World& a, World& b, const dem::Vec3& gravity) {
  std::string names;
  const auto compare = [&](const char* name, bool same) {
    if (!same) names += std::string(names.empty() ? "" : ", ") + name;
  };
  compare("time", a.time == b.time && a.step == b.step);
  compare("x", same_bits(a.bodies.x, b.bodies.x));
  compare("q", same_bits(a.bodies.q, b.bodies.q));
  compare("v", same_bits(a.bodies.v, b.bodies.v));
  compare("L", same_bits(a.bodies.L, b.bodies.L));
  compare("force", same_bits(a.bodies.force, b.bodies.force));
  compare("friction of pairs", same_bits(a.pairs.friction, b.pairs.friction));
  compare("surfaces", a.surfaces.size() == b.surfaces.size());
  for (std::size_t k = 0; k < std::min(a.surfaces.size(), b.surfaces.size()); ++k) {
    const Surface &s = a.surfaces[k], &t = b.surfaces[k];
    compare("nodes", same_bits(s.patch.node, t.patch.node));
    compare("velocity of nodes", same_bits(s.patch.velocity, t.patch.velocity));
    compare("forces on nodes", same_bits(s.patch.force, t.patch.force));
    compare("friction on the surface", same_bits(s.contacts.friction, t.contacts.friction));
    compare("wake on the surface", same_bits(s.contacts.wake, t.contacts.wake));
    std::vector<double> u, v;
    s.structure->save(u), t.structure->save(v);
    compare("structure", same_bits(u, v));
  }
  const EnergyFlows f = flows(a), g = flows(b);
  compare("friction loss", f.friction == g.friction);
  compare("transfer error", f.transfer_error == g.transfer_error);
  compare("ledger",
          closure(a.start, stores(a, gravity), f) == closure(b.start, stores(b, gravity), g));
  return names;
}

inline void save(World& w, const std::string& path) {
  ArchiveWriter archive(path);
  write_world(archive, w);
  archive.commit();
}

inline void load(World& w, const std::string& path) {
  ArchiveReader archive(path);
  read_world(archive, w);
  read_surfaces(archive, w);
}

}  // namespace trackbed::coupling
