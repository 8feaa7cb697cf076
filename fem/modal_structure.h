// A structure given by modes: the motion of its surface is u = Φ q, and every modal coordinate is
// an oscillator of its own,
//
//   q̈ᵢ + 2δᵢ q̇ᵢ + ωᵢ² qᵢ = φᵢ · f,      modes of unit modal mass, ω = 0 for rigid motions.
//
// Reduced bodies, beams and rigid bodies with chosen degrees of freedom are all of this kind.
//
// Time. Each oscillator is advanced exactly while the force is constant,
//   q₊ = A q + B q̇ + E p,   q̇₊ = C q + D q̇ + b₀ p + b₁ p₊,   p = φ·f,
// with A … E of the exact solution over Δt. The share of the new force, b₁ = tan(½ωΔt)/ω with
// b₀ + b₁ = B, makes the step symmetric in time (a trigonometric method: Hairer, Lubich, Wanner,
// Geometric Numerical Integration, ch. XIII.2), so that
//   - a constant force gives the exact static deflection, free vibration the exact frequency;
//   - the predicted surface is where it goes: no transfer error in the exchange;
//   - two masses on springs (tests/verification/fem_reduction_test.cc) do not grow at any ωΔt (a
//     force taken linear over the step would shift the predicted place by Δf Δt²/6 after the fact,
//     and damp).
// Modes with ωΔt > 1 only follow statically: their modal mass is raised to (ωΔt)², which leaves
// flexibility, rigid motion and momentum as they are.
//
// Stability. Without damping the step is q₊ − 2q + q₋ = (2 sin(½ωΔt)/ω)² (p − ω² q): leapfrog with
// the modal mass μ = (½ωΔt / sin ½ωΔt)² ≥ 1. With contact springs S on the surface and grains that
// go by leapfrog too, all is one leapfrog: stable while Δt² λ_max < 4. Of that the modes' own share
// is 4 sin²(½ωΔt) ≤ 4 sin² ½, as ωΔt ≤ 1, and the springs' at most Δt² λ_max(Φᵀ S Φ): what counts
// is the mass that the body as a whole opposes to the springs, not that of one node of its mesh.
//
// Cost of a step: two products with Φ, nodes × modes each. No solve, no factor.
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fem/structure.h"

namespace trackbed::fem {

/// Mean displacement of the patch a load acts on, and its direction.
struct ModalLoad {
  std::string name;
  Vec direction{0, 0, -1};
  std::vector<double> shape;  ///< x, y, z of each mode: 3 m
};

/// Something observed: a linear function of the modal coordinates (a moment, a point's motion).
struct ModalGauge {
  std::string name;
  std::vector<double> shape;  ///< m
};

/// What the reduction costs, against the full body. Deflections are those of the static answer; of
/// a body that is not held, of its elastic part (inertia relief).
struct ReductionReport {
  int unknowns = 0;  ///< of the full body
  int modes = 0;
  std::vector<std::pair<double, double>> frequencies;  ///< lowest elastic [Hz]: full, reduced
  double largest_frequency_error = 0;                  ///< of those, relative
  /// Work of a unit pressure on a contact boundary through the deflection it makes: 1 −
  /// reduced/full, the largest of all contact boundaries.
  double pressure_error = 0;
  /// The same for one force on the boundary's middle node, along its normal: the local dent. The
  /// mesh sets how soft it is; a modal body leaves most of it out.
  double node_error = 0;
};

struct ModalModel {
  std::string name = "body";  ///< for messages
  SurfaceMesh surface;
  std::vector<double> omega;     ///< ω of each mode [rad/s], 0 = rigid
  double damping_mass = 0;       ///< α_M [1/s]; δ = ½(α_M + α_K ω²)
  double damping_stiffness = 0;  ///< α_K [s]
  std::vector<double> shape;     ///< Φ: row 3 node + direction, m columns [kg^-1/2]
  std::vector<ModalLoad> loads;
  std::vector<ModalGauge> gauges;
  std::vector<double> gravity;  ///< modal force of the body's weight; empty: none
  bool start_in_equilibrium = false;
  double mass = 0, least_surface_mass = 0;
  std::shared_ptr<const ReductionReport> report = {};  ///< of a reduced body
  /// Writes the fields of the whole body for its modal coordinates and velocities; may be empty.
  std::function<void(const std::string& file, const std::vector<double>& q,
                     const std::vector<double>& v)>
      write = {};
};

class ModalStructure final : public Structure {
 public:
  /// At rest at t = 0, or in equilibrium under its weight. \throws InputError if sizes do not fit.
  explicit ModalStructure(ModalModel);

  const SurfaceMesh& surface() const override { return m_.surface; }
  void set_step(double dt) override;
  double explicit_limit() const override { return std::numeric_limits<double>::infinity(); }
  void predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  void advance(const std::vector<Vec>& surface_forces) override;
  void motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  int loads() const override { return static_cast<int>(m_.loads.size()); }
  void set_load(int load, double newton) override;
  Vec load_displacement(int load) const override;
  double mass() const override { return m_.mass; }
  double least_surface_mass() const override { return m_.least_surface_mass; }
  double largest_frequency() const override;
  /// The lesser of λ + ω_max² and λ / cos² ½, λ = λ_max(Φᵀ S Φ) (see Stability above), λ from above
  /// and at most (modes)^(1/64) too large; by nodes beyond 128 modes, where that would cost more
  /// than it gains.
  double contact_bound(const std::vector<NodeSpring>&) const override;
  int unknowns() const override { return modes(); }
  StructureEnergy energy() const override;
  void save(std::vector<double>& state) const override;
  void load(const std::vector<double>& state) override;
  bool has_fields() const override { return static_cast<bool>(m_.write); }
  void write_vtu(const std::string& file) const override;

  const ModalModel& model() const { return m_; }
  double gauge(int k) const;  ///< its value now
  int modes() const { return static_cast<int>(m_.omega.size()); }
  const std::vector<double>& coordinates() const { return q_; }

  /// q = p/ω² under loads, weight and surface forces (empty: none); at rest afterwards.
  /// \throws InputError if a rigid motion is loaded: the body is not held.
  void solve_static(const std::vector<Vec>& surface_forces = {});

  /// Same velocity everywhere in modal coordinates [kg^1/2 m/s].
  void set_modal_velocity(const std::vector<double>& v);

 private:
  struct Step {  // coefficients of one mode
    double a, b, c, d, e, b0, b1, mass;
  };
  void outer_force(std::vector<double>& p) const;
  void add_surface(const std::vector<Vec>& forces, std::vector<double>& p) const;
  void place(const std::vector<double>& q, std::vector<Vec>& u) const;
  double kinetic() const;
  double strain() const;
  double gravity_potential() const;
  void start_ledger();
  double by_powers(const std::vector<NodeSpring>&) const;
  double by_iterations(const std::vector<NodeSpring>&) const;  // of many modes

  ModalModel m_;
  std::vector<Step> step_;
  double dt_ = 0;
  std::vector<double> q_, v_;
  std::vector<double> force_, surface_force_;  // modal, at t: all of it, and the contacts' share
  std::vector<double> load_;                   // [N]
  double work_loads_ = 0, work_surface_ = 0, damping_ = 0, at_start_ = 0;
  mutable std::vector<double> next_q_, next_v_;
  std::vector<double> next_force_, next_surface_;
};

}  // namespace trackbed::fem
