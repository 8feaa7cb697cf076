// Contact forces of all pairs. Law and friction are fixed when the scene is built: the factory
// hands out one instance of a template, the pair loop has no branch on them.
//
//   pairs apart by their cached axis are left (most of them without touching any geometry);
//   touching: contact frame -> overlap -> law -> pressure over the overlap's boundary -> force,
//   moment -> friction. Each pair writes its own slot; sum_forces then adds the slots of each
//   body in ascending order of pairs. So the result is bitwise the same for any thread count.
#pragma once
#include <string>
#include <vector>

#include "dem/contact/candidates.h"
#include "dem/contact/laws/pressure_law.h"
#include "dem/contact/pairs.h"

namespace trackbed::dem {

/// Constants of each pair of materials, symmetric. An entry that was never set has NaN modulus.
class PairMaterials {
 public:
  explicit PairMaterials(int materials = 0);
  void set(int i, int j, const PairMaterial& m);
  const PairMaterial& operator()(int i, int j) const { return table_[i * n_ + j]; }
  int materials() const { return n_; }
  bool has_friction() const;
  bool has_damping() const { return damped_; }  ///< in contacts, of some pair

 private:
  int n_ = 0;
  bool damped_ = false;
  std::vector<PairMaterial> table_;
};

/// E of a pair of bodies, 2 E1 E2/(E1+E2) [Pa].
inline double mixed_modulus(double e1, double e2) { return 2 * e1 * e2 / (e1 + e2); }

/// An evaluation chosen by name: fills the result slots and advances the history of all pairs.
/// `travel` is Candidates::travel(). Friction moves by the step that led here (v, turn after
/// drift, times dt); with dt = 0 no step led here and friction stays: the first evaluation of a
/// stage.
struct PairForces {
  using Evaluate = void (*)(const Bodies&, const ShapeTable&, const PairMaterials&,
                            const StepContext&, const std::vector<double>& travel, Pairs&);
  std::string law;
  bool stores_energy = false;  ///< the law is the gradient of a stored energy
  bool friction = false;
  Evaluate evaluate = nullptr;
};

/// Laws: "stored_energy", "shao2017". `friction` off leaves the tangential part out altogether.
/// Throws InputError naming the laws there are.
PairForces make_pair_forces(const std::string& law, bool friction);
std::vector<std::string> pair_law_names();

/// Sets Bodies::force and torque to the sums over each body's pairs, in fixed order.
void sum_forces(const Pairs&, const StepContext&, Bodies&);

/// Forgets friction and contact results (a new stage may start from a shaken-out state).
void forget_friction(Pairs&);

}  // namespace trackbed::dem
