// A linear elastic body of deal.II hexahedra in small displacements, with inertia:
//
//   M a + C v + K u = f,   K = ∫Bᵀ D B dV,  M = ∫ρ NᵀN dV,  C = Σ(α_M M + α_K K) + dashpots
//
// in time by generalised-α (Chung, Hulbert 1993): spectral radius ρ_∞ at high frequency,
//   α_m = (2ρ_∞−1)/(ρ_∞+1), α_f = ρ_∞/(ρ_∞+1), γ = ½−α_m+α_f, β = ¼(1−α_m+α_f)²
// or Newmark's average acceleration (β ¼, γ ½); a body with lumped mass and no damping goes by
// velocity Verlet, without a solve, where Δt ≤ 0.9·2/ω_max. SI units, z up,
// positions relative to the scene's origin.
#pragma once
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fem/linear_solver.h"
#include "fem/materials/model.h"
#include "fem/structure.h"
#include "fem/time_integration.h"

namespace trackbed::fem {

inline constexpr double kMustBeSet = std::numeric_limits<double>::quiet_NaN();

/// Constants of Rayleigh damping, C = α_M M + α_K K.
struct RayleighDamping {
  double mass = 0;       ///< α_M [1/s] ≥ 0
  double stiffness = 0;  ///< α_K [s] ≥ 0
};

/// Those that damp modes of the angular frequencies `low` < `high` [rad/s] by the share `ratio` of
/// critical damping, ξ = (α_M/ω + α_K ω)/2; modes between them less, by ratio·2√(low high)/(low +
/// high) at least, others more.
RayleighDamping rayleigh_damping(double ratio, double low, double high);

/// One material of a body. `model`, when given, replaces E, ν, ρ.
struct Material {
  std::string name;
  double young = kMustBeSet;      ///< E [Pa] > 0
  double poisson = kMustBeSet;    ///< ν [-], −1 < ν < ½
  double density = kMustBeSet;    ///< ρ [kg/m3] > 0
  double rayleigh_mass = 0;       ///< α_M [1/s] ≥ 0
  double rayleigh_stiffness = 0;  ///< α_K [s] ≥ 0
  std::shared_ptr<const MaterialModel> model = {};
};

/// A horizontal layer of a box mesh.
struct Layer {
  double thickness = kMustBeSet;  ///< [m]
  int elements = 1;               ///< over the thickness
  int material = 0;               ///< index into ElasticBodyParameters::materials
};

/// Where the cells come from: a box, or a Gmsh file if `file` is not empty.
/// Box: boundaries x_min, x_max, y_min, y_max, bottom, top. With `layers` (bottom to top) the
/// height is the sum of their thicknesses and lengths[2], elements[2] are ignored; without, one
/// material 0. File: .msh (version 2 or 4, ASCII), hexahedra; boundaries are named by physical
/// surfaces, materials by physical volumes, each by its name or its number; `region_material` maps
/// them to the list.
struct MeshParameters {
  Vec corner{0, 0, 0};  ///< lower corner of the box [m]; for a file: shift of its nodes
  Vec lengths{kMustBeSet, kMustBeSet, kMustBeSet};  ///< [m]
  std::array<int, 3> elements{1, 1, 1};
  std::array<std::vector<double>, 3> widths;  ///< cell widths along an axis [m]; if given, instead
                                              ///< of length and elements (graded meshes)
  std::vector<Layer> layers;
  std::string file;
  std::map<std::string, int> region_material;  ///< physical volume -> index into materials
};

enum class Support : std::uint8_t {
  free,
  fixed,    ///< u = 0
  roller,   ///< u·n = 0; the boundary must be normal to an axis
  periodic  ///< both boundaries of a pair (x_min/x_max or y_min/y_max), meshes must match
};

/// Springs and dashpots per area on a boundary [N/m3], [N s/m3]: a Winkler or Kelvin–Voigt bed
/// under a body, or an absorbing boundary.
///
/// Absorbing: dashpots ρc_p normal and ρc_s along the boundary are added, of the material that
/// meets it (Lysmer, Kuhlemeyer 1969; c_p² = (λ+2μ)/ρ, c_s² = μ/ρ); with `distance` R > 0 [m] from
/// the load also springs α G/R, α = 4/3 normal and 2/3 along (viscous-spring boundary, Liu, Du, Du,
/// Wang, Wu 2006), which hold the body for static loads.
struct Bed {
  std::string boundary;
  double normal_stiffness = 0, shear_stiffness = 0;
  double normal_dashpot = 0, shear_dashpot = 0;
  bool absorbing = false;
  double distance = 0;

  bool has_dashpots() const { return absorbing || normal_dashpot > 0 || shear_dashpot > 0; }
  bool has_springs(bool normal) const {
    return (normal ? normal_stiffness : shear_stiffness) > 0 || (absorbing && distance > 0);
  }
};

/// A resultant force [N] spread evenly over a boundary, or over the rectangle on it (seen from
/// above) with the given centre and size: a rail seat. Force and moment are those of the even load
/// exactly.
struct Load {
  std::string name;
  std::string boundary = "top";
  bool rectangle = false;
  double centre_x = 0, centre_y = 0;  ///< [m]
  double size_x = 0, size_y = 0;      ///< [m]
  Vec direction{0, 0, -1};            ///< of a positive force, made a unit vector
};

/// How Q1 cells are kept from locking. Q2 needs none of them.
enum class Element : std::uint8_t {
  standard,      ///< full integration; order 1 locks in bending
  incompatible,  ///< order 1 only: Wilson–Taylor modes, exact in bending for rectangular cells
  b_bar          ///< order 1 only: mean dilatation (Hughes 1980), for ν near ½
};

/// Lumped (row sums): no solve at steps below its stability limit; turns a cell's own rotary
/// inertia up, which a slab held at its base does not feel and a thin free beam does. Consistent:
/// always implicit. Automatic: lumped if supports and beds hold the body, else consistent.
enum class Mass : std::uint8_t { automatic, consistent, lumped };

struct ElasticBodyParameters {
  std::string name = "body";  ///< for messages: the section of the parameter file
  MeshParameters mesh;
  std::vector<Material> materials;
  int order = 1;                            ///< of the elements, 1 or 2
  Element element = Element::incompatible;  ///< for order 2: always standard
  std::map<std::string, Support> supports;  ///< boundary -> support; not named: free
  std::vector<Bed> beds;
  std::vector<Load> loads;
  std::vector<std::string> contact;  ///< boundaries that make the contact surface
  Vec gravity{0, 0, 0};  ///< acceleration [m/s2] as body force; {0,0,-9.81} to switch it on
  bool start_in_equilibrium = true;  ///< held bodies: start at rest under gravity, not falling
  bool newmark = false;              ///< average acceleration instead of generalised-α
  TimeScheme scheme = TimeScheme::automatic;
  SolverKind solver = SolverKind::automatic;
  Mass mass = Mass::automatic;
  double rho_inf = 0.9;  ///< spectral radius at high frequency [-], 0 … 1
};

/// One line of a .pvd file.
struct PvdRecord {
  double time;
  std::string file;  ///< relative to the .pvd
};

class ElasticBody final : public Structure {
 public:
  /// Builds mesh and matrices; at rest at t = 0. \throws InputError naming body, key and what is
  /// allowed (E ≤ 0, ν ≥ ½, unknown boundary or region, inverted cell, load outside its boundary,
  /// ...).
  explicit ElasticBody(ElasticBodyParameters);
  ~ElasticBody() override;

  const SurfaceMesh& surface() const override;
  void set_step(double dt) override;
  double explicit_limit() const override;
  void predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  void advance(const std::vector<Vec>& surface_forces) override;
  void motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const override;
  int loads() const override;
  void set_load(int load, double newton) override;
  Vec load_displacement(int load) const override;
  double mass() const override;
  double least_surface_mass() const override;
  double largest_frequency() const override;
  /// By nodes; and ω_max² more where it goes without a solve.
  double contact_bound(const std::vector<NodeSpring>&) const override;
  double largest_step() const override;
  int unknowns() const override;
  StructureEnergy energy() const override;
  void save(std::vector<double>& state) const override;
  void load(const std::vector<double>& state) override;
  bool has_fields() const override { return true; }
  void write_vtu(const std::string& file) const override;

  const ElasticBodyParameters& parameters() const;

  /// Whether the step as set goes without a solve.
  bool is_explicit() const;

  /// Iterations of the last linear solve; 0 for a direct or no solve.
  int solver_iterations() const;

  /// Shifts the body at rest (its reference) by this much [m]: the sleeper set down on a packed
  /// bed.
  void translate(const Vec& shift);

  /// Same velocity everywhere [m/s]; the accelerations follow from the loads as set.
  void set_velocity(const Vec& velocity);

  /// Static answer K u = loads + gravity + surface forces (empty: none); v = a = 0 afterwards.
  /// \throws InputError if the body is not held (singular), saying which motion is free.
  void solve_static(const std::vector<Vec>& surface_forces = {});

  /// Displacement [m] at a point of the body, by its elements. \throws InputError outside the body.
  Vec displacement_at(const Vec& point) const;

  /// Momentum [kg m/s] of the body, and the sum of all forces of supports and beds on it [N].
  Vec momentum() const;
  Vec reaction() const;

  /// Lowest `count` natural frequencies [Hz], rigid modes (≈0) included, by SLEPc.
  std::vector<double> frequencies(int count) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A .pvd file that lists VTU files by time; written aside, then renamed.
void write_pvd(const std::string& file, const std::vector<PvdRecord>& records);

}  // namespace trackbed::fem
