// Pairs of convex parts of bodies that touch or may soon touch: history that lives on from step to
// step, and the results of the last evaluation. Structure of arrays, sorted by kind, so that each
// kind has a plain loop of its own; within a kind first those whose bodies touched at the last
// search, in a row, which are what a step works on, then the others; then by bodies and parts
// (PairKey).
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <vector>

#include "dem/contact/overlap.h"
#include "dem/types.h"

namespace trackbed::dem {

/// What a pair of parts is made of. Roles: a has the first core, b the second; where both may be
/// the same, a < b.
enum class PairKind : std::uint8_t {
  polyhedra,   ///< plain on plain
  balls,       ///< spheres about their bodies' centres
  points,      ///< spheres, not both centred: clumps
  point_core,  ///< sphere on polyhedron, dilated or plain
  cores        ///< dilated on dilated or plain
};
inline constexpr int kPairKinds = 5;

struct PairKey {
  PairKind kind;
  int a, b, part_a, part_b;
  bool operator<(const PairKey& o) const {
    return std::tie(kind, a, b, part_a, part_b) < std::tie(o.kind, o.a, o.b, o.part_a, o.part_b);
  }
  bool operator==(const PairKey& o) const {
    return std::tie(kind, a, b, part_a, part_b) == std::tie(o.kind, o.a, o.b, o.part_a, o.part_b);
  }
};

struct Pairs {
  std::vector<int> a, b;            ///< bodies
  std::vector<int> part_a, part_b;  ///< of the bodies' shapes
  std::vector<std::uint8_t> kind;   ///< PairKind

  // History. `wake`: the pair is apart until travel[a] + travel[b] (Candidates) passes it [m].
  std::vector<Vec3> axis;                      ///< direction a to b of least separation, any length
  std::vector<double> wake;                    ///< [m]
  std::vector<Vec3> friction;                  ///< tangential force on a [N]
  std::vector<double> friction_stiffness;      ///< k_t of the last step [N/m]; 0 = was not touching
  std::vector<int> feature, faces_a, faces_b;  ///< of the last overlap (OverlapFeature)
  std::vector<Vec3> arm_a, arm_b;              ///< contact point less centre of a, of b [m]

  // Results of the last evaluation; zero for a pair that does not touch.
  std::vector<std::uint8_t> touching;
  std::vector<Vec3> force;   ///< on a, normal + friction [N]; on b its negative
  std::vector<Vec3> couple;  ///< moment on a about the contact point [N m]; on b its negative
  std::vector<double> normal_force;     ///< size of `force` without friction, along -axis [N]
  std::vector<double> energy;           ///< stored in the normal contact [J]
  std::vector<double> friction_energy;  ///< stored in the tangential spring [J]
  std::vector<double> friction_loss;    ///< dissipated in this step [J]
  std::vector<double> viscous;          ///< damping force, elastic + viscous = normal [N]; history
  std::vector<double> viscous_loss;     ///< dissipated by it in this step [J]
  std::vector<double> area;             ///< size of the overlap's vector area [m2]
  std::vector<double> depth;            ///< extent of the overlap along the frame's normal [m]
  std::vector<double> stiffness;        ///< normal [N/m]
  std::vector<double> tilt_stiffness;   ///< of the couple, largest over the tangents [N m]

  // Moments against turning (resistance.h); empty unless `resists`.
  bool resists = false;
  std::vector<double> torsion, torsion_stiffness;  ///< on a, along axis [N m]; [N m/rad]
  std::vector<Vec3> rolling;                       ///< on a [N m]
  std::vector<double> rolling_stiffness;           ///< [N m/rad]

  // Which pairs belong to body i: incident[first[i] .. first[i+1]), ascending; an entry is the
  // pair's index p where i is a, and ~p where i is b. Follows from a, b (index_bodies).
  std::vector<int> first, incident;

  std::vector<OverlapWorkspace> workspaces;  ///< scratch, one a thread

  // Of pairs of balls: their radii [m] and places in ShapeTable::ball. Follow from the bodies'
  // shapes and the parts; found by the first evaluation after index_bodies.
  std::vector<double> radius_a, radius_b;
  std::vector<int> ball_a, ball_b;

  std::array<int, kPairKinds + 1> kind_first{};  ///< range of each kind (index_bodies)
  std::array<int, kPairKinds> kind_busy{};  ///< one past the last that touched then (index_bodies)

  int size() const { return static_cast<int>(a.size()); }
  int begin(PairKind k) const { return kind_first[static_cast<int>(k)]; }
  int end(PairKind k) const { return kind_first[static_cast<int>(k) + 1]; }
  int busy_end(PairKind k) const { return kind_busy[static_cast<int>(k)]; }
  /// Of those that are not polyhedra.
  int round() const { return size() - end(PairKind::polyhedra); }
  PairKey key(int p) const {
    return {static_cast<PairKind>(kind[p]), a[p], b[p], part_a[p], part_b[p]};
  }
  void set_key(int p, const PairKey& k) {
    kind[p] = static_cast<std::uint8_t>(k.kind);
    a[p] = k.a, b[p] = k.b, part_a[p] = k.part_a, part_b[p] = k.part_b;
  }
  void resize(int pairs);  ///< new entries are zero
  /// New entry p takes over all of the old entry old[p], or zeros where that is -1.
  void rearrange(const std::vector<int>& old);
  void keep_resistance();         ///< from here on with the moments against turning
  void index_bodies(int bodies);  ///< rebuilds first, incident, kind_first, kind_busy
};

/// Calls f(name, array) for each array that a checkpoint must hold so that the next step is
/// bitwise the same; results that the next evaluation overwrites are included because output may
/// read them before. After reading back: index_bodies.
template <class P, class F>
void for_each_pair_array(P& p, F&& f) {
  f("a", p.a), f("b", p.b), f("part_a", p.part_a), f("part_b", p.part_b), f("kind", p.kind);
  f("axis", p.axis), f("wake", p.wake), f("feature", p.feature);
  f("faces_a", p.faces_a), f("faces_b", p.faces_b);
  f("friction", p.friction), f("friction_stiffness", p.friction_stiffness);
  f("arm_a", p.arm_a), f("arm_b", p.arm_b);
  f("touching", p.touching);
  f("force", p.force), f("couple", p.couple), f("normal_force", p.normal_force);
  f("energy", p.energy), f("friction_energy", p.friction_energy);
  f("friction_loss", p.friction_loss);
  f("viscous", p.viscous), f("viscous_loss", p.viscous_loss);
  f("area", p.area), f("depth", p.depth), f("stiffness", p.stiffness);
  f("tilt_stiffness", p.tilt_stiffness);
  if (!p.resists) return;
  f("torsion", p.torsion), f("torsion_stiffness", p.torsion_stiffness);
  f("rolling", p.rolling), f("rolling_stiffness", p.rolling_stiffness);
}

template <class F>
void for_each_array(Pairs& p, F&& f) {
  for_each_pair_array(p, f);
}
template <class F>
void for_each_array(const Pairs& p, F&& f) {
  for_each_pair_array(p, f);
}

/// What to add to the place of a body at b so that it is the image nearest to a.
inline Vec3 nearest_image(const Vec3& a, const Vec3& b, const Vec3& period) {
  Vec3 shift = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    const double apart = b[d] - a[d];
    if (period[d] > 0 && 2 * std::abs(apart) >= period[d])
      shift[d] = -period[d] * std::round(apart / period[d]);
  }
  return shift;
}

/// Number of touching pairs.
int count_contacts(const Pairs&);

}  // namespace trackbed::dem
