// What every structure with a contact surface gives to the coupling: nodal forces in, nodal motion
// out. ElasticBody (3-D elements), PointBed, ModalStructure, ... are structures; the coupling knows
// this file only.
//
// One step, once set_step(dt) was called:
//   predict(u, v)    where the surface will be at t+dt, for the contact forces; changes no state
//   advance(forces)  the forces found there, at t+dt, one per surface node; the state becomes t+dt
// The same forces act on the grains: action equals reaction to the last bit.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace trackbed::fem {

using Vec = std::array<double, 3>;

/// An edge of a contact quad: shared with another quad, at the rim of the surface, or at a periodic
/// seam (the surface goes on at the other side, one period further).
enum class Edge : std::uint8_t { inner, border, seam };

/// The contact surface at rest. All nodes carry degrees of freedom of the structure.
struct SurfaceMesh {
  std::vector<Vec> nodes;  ///< reference positions [m]
  std::vector<std::array<int, 4>>
      quads;  ///< node ids, counter-clockwise seen from outside the body
  std::vector<std::array<Edge, 4>>
      edges;                  ///< edge k of a quad runs from its node k to node (k+1)%4
  std::vector<int> boundary;  ///< per quad: which name of the list of contact boundaries
  std::vector<int>
      same_as;  ///< per node: itself, or the node it is the periodic image of (moves with it)
  Vec period{0, 0, 0};  ///< length of the period along x and y [m], 0 = not periodic
};

/// Energies [J] since the start. Works are sums of ½(F_n + F_{n+1})·(u_{n+1} − u_n).
/// work_loads + work_surface + at_start = kinetic + strain + gravity + dissipated_damping +
/// dissipated_boundary + dissipated_material + numerical, where `numerical` (what the time
/// integration took out, or put in) is what remains: zero to round-off for Newmark's average
/// acceleration.
struct StructureEnergy {
  double kinetic = 0, strain = 0, gravity = 0;
  double work_loads = 0, work_surface = 0;
  double dissipated_damping = 0;
  double numerical = 0;
  double at_start = 0;
  double dissipated_material = 0;  ///< plastic work of a material with history
  double dissipated_boundary = 0;  ///< in dashpots of boundaries: what waves carry away
};

/// What contacts put on a surface node, as a spring to a place at rest: symmetric [N/m].
struct NodeSpring {
  int node;
  std::array<Vec, 3> stiffness;
  double largest;  ///< eigenvalue
};

class Structure {
 public:
  virtual ~Structure() = default;

  virtual const SurfaceMesh& surface() const = 0;

  /// Time step [s] of the following steps. Factors are kept per dt: a ladder of halves costs one
  /// factorisation a rung. \throws InputError if dt is not positive.
  virtual void set_step(double dt) = 0;

  /// Largest step [s] that goes without a solve, the surface just where predict() says; 0: none.
  virtual double explicit_limit() const { return 0; }

  /// Surface nodes at t+dt: u + dt v + ½ dt² a [m] and v + dt a [m/s]. Vectors are resized.
  virtual void predict(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const = 0;

  /// One step with these forces [N] on the surface nodes at t+dt (forces on a node and on its
  /// periodic image add up). \throws RunError if a force is not finite.
  virtual void advance(const std::vector<Vec>& surface_forces) = 0;

  /// Surface nodes now, at t: displacement [m] and velocity [m/s].
  virtual void motion(std::vector<Vec>& displacement, std::vector<Vec>& velocity) const = 0;

  /// The loads the structure was built with: force [N] from the next advance() on, along the load's
  /// direction (default: downwards positive).
  virtual int loads() const = 0;
  virtual void set_load(int load, double newton) = 0;
  /// Mean displacement [m] over the patch a load acts on, weighted as the load is (work-conjugate).
  virtual Vec load_displacement(int load) const = 0;

  virtual double mass() const = 0;  ///< [kg]
  virtual double least_surface_mass()
      const = 0;  ///< least lumped mass of a surface node that can move [kg]
  virtual double largest_frequency()
      const = 0;  ///< upper estimate of ω_max of the full model [rad/s]

  /// ω² [1/s²], so that steps up to 2/ω are stable with these springs on the surface, at most one a
  /// node; springs come with twice the contacts' stiffness (coupling/time_step.h). By default λ_max(M⁻¹K) ≤ largest spring / least mass of a node.
  virtual double contact_bound(const std::vector<NodeSpring>& springs) const {
    double stiffest = 0;
    for (const NodeSpring& s : springs) stiffest = std::max(stiffest, s.largest);
    return stiffest / least_surface_mass();
  }
  /// Largest time step [s] of an explicit scheme that was asked for by name; others: infinite.
  virtual double largest_step() const { return std::numeric_limits<double>::infinity(); }
  virtual int unknowns() const = 0;

  virtual StructureEnergy energy() const = 0;  ///< computed on demand

  /// The whole dynamic state, bitwise; `load` continues as if never stopped. The parameters are not
  /// in it: build the same structure first. \throws InputError if the length does not fit.
  virtual void save(std::vector<double>& state) const = 0;
  virtual void load(const std::vector<double>& state) = 0;

  /// Fields of the whole body (displacement, velocity, stresses, material) as VTU; written aside,
  /// then renamed. \throws RunError if the file cannot be written.
  virtual bool has_fields() const { return false; }
  virtual void write_vtu(const std::string& /*file*/) const {}
};

}  // namespace trackbed::fem
