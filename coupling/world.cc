#include "coupling/world.h"

#include "dem/motion/energy.h"

namespace trackbed::coupling {

using dem::Vec3;

Surface make_surface(const std::string& name, int material, double shell_depth, double skirt,
                     const Vec3& period, std::unique_ptr<fem::Structure> structure) {
  const fem::SurfaceMesh& mesh = structure->surface();
  std::vector<Vec3> nodes;
  for (const auto& p : mesh.nodes) nodes.push_back({p[0], p[1], p[2]});
  Surface s;
  s.patch = dem::make_patch(name, material, nodes, mesh.quads, shell_depth, skirt, period);
  structure->motion(s.displacement, s.velocity);
  for (int i = 0; i < s.patch.carried; ++i)
    s.patch.node[i] += Vec3(s.displacement[i][0], s.displacement[i][1], s.displacement[i][2]);
  dem::move_skirt(s.patch);
  s.last_force = s.given = s.owed = s.owed_before = s.patch.force;
  s.forces.resize(nodes.size());
  s.structure = std::move(structure);
  return s;
}

void evaluate_surface(World& w, Surface& s, const dem::StepContext& c) {
  w.patch_forces(w.bodies, w.shapes, w.materials, c, w.candidates.travel(), s.patch, s.contacts);
  if (s.contacts.round < s.contacts.size())
    w.round_patch_forces(w.bodies, w.shapes, w.materials, c, w.candidates.travel(), s.patch,
                         s.contacts);
}

EnergyStores stores(const World& w, const Vec3& gravity) {
  EnergyStores e;
  const dem::Energies d = dem::energies(w.bodies, w.pairs, gravity);
  e.kinetic = d.kinetic, e.gravity = d.gravity, e.contact = d.normal + d.tangential;
  for (const Surface& s : w.surfaces) {
    for (int k = 0; k < s.contacts.size(); ++k)
      e.contact += s.contacts.energy[k] + s.contacts.friction_energy[k];
    const fem::StructureEnergy f = s.structure->energy();
    e.structure += f.kinetic + f.strain + f.gravity;
  }
  return e;
}

EnergyFlows flows(const World& w) {
  EnergyFlows f = w.flows;
  for (const Surface& s : w.surfaces) {
    const fem::StructureEnergy e = s.structure->energy();
    f.work += e.work_loads - s.start.work_loads;
    f.structure_damping += e.dissipated_damping - s.start.dissipated_damping;
    f.structure_boundary += e.dissipated_boundary - s.start.dissipated_boundary;
    f.structure_plastic += e.dissipated_material - s.start.dissipated_material;
    f.structure_numerical += e.numerical - s.start.numerical;
    f.transfer_error += s.work_predicted - (e.work_surface - s.start.work_surface);
  }
  return f;
}

void open_ledger(World& w, const Vec3& gravity) {
  w.flows = {};
  for (Surface& s : w.surfaces) {
    s.work_predicted = 0;
    s.start = s.structure->energy();
  }
  w.start = stores(w, gravity);
}

int count_contacts(const World& w) {
  int n = dem::count_contacts(w.pairs);
  for (const Surface& s : w.surfaces) n += dem::count_contacts(s.contacts);
  return n;
}

double coordination(const World& w) {
  const int grains = w.bodies.grains;
  long ends = 0;
  int a = -1, b = -1;  // two that touch with several of their parts, which follow each other, once
  for (int p = 0; p < w.pairs.size(); ++p) {
    if (!w.pairs.touching[p] || (w.pairs.a[p] == a && w.pairs.b[p] == b)) continue;
    a = w.pairs.a[p], b = w.pairs.b[p];
    ends += (a < grains) + (b < grains);
  }
  for (const Surface& s : w.surfaces) ends += dem::count_contacts(s.contacts);
  return grains ? static_cast<double>(ends) / grains : 0;
}

}  // namespace trackbed::coupling
