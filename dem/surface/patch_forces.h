// Contact of grains with a deforming surface: one contact per convex part of a grain and patch.
// Plain polyhedra here; spheres and dilated polyhedra in surface/round_patch.h.
//
// The grain is cut with what lies behind each facet it reaches (surface/facet_cut.h; where that
// does not do, with the facet's three shell cells, tetrahedra, by the same kernel as grain on
// grain); the moments are summed; the law is evaluated once; each surface node gets
//   f_i = -int p N_i n dA   over the clipped outer pieces (N_i linear on the triangle),
// the exact gradient of the stored energy with respect to the node. The grain gets the opposite
// resultant and moment of these nodal forces, to round-off. Friction acts at the centroid of the
// clipped surface area and goes to the nodes by their share of that area; one history per grain
// and patch, so that a grain crossing an element edge feels nothing.
//
// A shell cell: each triangle (a, b, c), sorted by node id, and its inner nodes a', b', c' make
// three tetrahedra (a b c c'), (a b b' c'), (a a' b' c'); the diagonal of each side runs from the
// lower outer to the higher inner node, so that neighbours fit without gap.
#pragma once
#include <utility>
#include <vector>

#include "dem/contact/pair_forces.h"
#include "dem/surface/patch.h"

namespace trackbed::dem {

struct PatchContacts {
  // Candidates, from the last search: contact k is part[k] of grain[k] with triangles [first[k],
  // first[k+1]). Plain polyhedra first, from `round` on spheres and dilated polyhedra.
  std::vector<int> grain, part, first;
  int round = 0;
  std::vector<int> triangle;
  std::vector<Vec3> shift;   ///< periodic image of the triangle [m]
  std::vector<Vec3> axis;    ///< separating axis, grain to facet, as in Pairs
  std::vector<double> wake;  ///< apart until travel[grain] + node_travel passes it [m]
  double node_travel = 0;    ///< sum of the largest node motion of each step [m]
  double searched_at = 0;    ///< node_travel of the last search [m]

  // History and results per contact, as in Pairs; forces act on the grain.
  std::vector<Vec3> friction, arm;
  std::vector<double> friction_stiffness;
  std::vector<std::uint8_t> touching;
  std::vector<Vec3> force, torque;  ///< on the grain, torque about its centre [N], [N m]
  std::vector<Vec3> normal_force, point;
  std::vector<double> energy, friction_energy, friction_loss, area, depth, stiffness;
  std::vector<double> tilt_stiffness;  ///< as in Pairs [N m]
  std::vector<double> viscous, viscous_loss;

  // Forces on nodes, per contact, of the last evaluation.
  std::vector<std::vector<std::pair<int, Vec3>>> nodal;
  std::vector<OverlapWorkspace> workspaces;
  std::vector<int> awake;  ///< of plain polyhedra, at the last evaluation

  int size() const { return static_cast<int>(grain.size()); }
};

/// The arrays with one value per triangle entry, and those with one per contact.
template <class F>
void for_each_triangle_array(PatchContacts& p, F&& f) {
  f("triangle", p.triangle), f("shift", p.shift), f("axis", p.axis), f("wake", p.wake);
}
template <class F>
void for_each_contact_array(PatchContacts& p, F&& f) {
  f("grain", p.grain), f("part", p.part), f("friction", p.friction), f("arm", p.arm);
  f("friction_stiffness", p.friction_stiffness), f("touching", p.touching);
  f("force", p.force), f("torque", p.torque), f("normal_force", p.normal_force);
  f("point", p.point), f("energy", p.energy), f("friction_energy", p.friction_energy);
  f("friction_loss", p.friction_loss), f("area", p.area), f("depth", p.depth);
  f("stiffness", p.stiffness), f("tilt_stiffness", p.tilt_stiffness);
  f("viscous", p.viscous), f("viscous_loss", p.viscous_loss);
}
/// As for Pairs: all that a checkpoint must hold.
template <class F>
void for_each_array(PatchContacts& p, F&& f) {
  f("first", p.first);
  for_each_triangle_array(p, f);
  for_each_contact_array(p, f);
}

/// Searches the triangles near each grain (boxes grown by `reach` [m]); history of contacts that
/// stay is kept, touching ones always stay.
void search_patch(const Bodies&, const ShapeTable&, const SurfacePatch&, const StepContext&,
                  double reach, PatchContacts&);

/// The contacts of spheres and dilated polyhedra start at `round`; call it after reading back.
void find_round(const Bodies&, const ShapeTable&, PatchContacts&);

/// After bodies were put in another order: grain i is now grain now[i], or gone where that is -1.
void renumber_grains(PatchContacts&, const std::vector<int>& now);

using EvaluatePatch = void (*)(const Bodies&, const ShapeTable&, const PairMaterials&,
                               const StepContext&, const std::vector<double>& travel,
                               const SurfacePatch&, PatchContacts&);

/// Evaluation by the law's name, as make_pair_forces. Throws InputError naming the laws there are.
/// The evaluation throws RunError naming a grain that reaches past the bottom of the shell.
EvaluatePatch make_patch_forces(const std::string& law, bool friction);

/// Adds the contacts' forces to the grains, in fixed order.
void sum_grain_forces(const PatchContacts&, Bodies&);

/// Writes SurfacePatch::force, in fixed order.
void sum_node_forces(const PatchContacts&, SurfacePatch&);

/// Both.
void sum_patch_forces(const PatchContacts&, Bodies&, SurfacePatch&);

int count_contacts(const PatchContacts&);

}  // namespace trackbed::dem
