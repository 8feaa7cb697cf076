// Everything that moves in a scene, and one coupled step of it.
//
//   grains move -> structures say where their surface goes -> candidates -> contact forces
//   -> structures advance with the surface forces -> grains take their new velocities
//
// One force per contact acts on both sides; when it is exchanged is the schedule's affair
// (coupling/exchange.h).
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coupling/exchange.h"
#include "coupling/ledger.h"
#include "dem/contact/candidates.h"
#include "dem/contact/pair_forces.h"
#include "dem/contact/pairs.h"
#include "dem/contact/resistance.h"
#include "dem/contact/round_forces.h"
#include "dem/contact/shape_table.h"
#include "dem/motion/adaptive_damping.h"
#include "dem/motion/bodies.h"
#include "dem/motion/motion.h"
#include "dem/surface/patch.h"
#include "dem/surface/patch_forces.h"
#include "dem/surface/round_patch.h"
#include "fem/structure.h"

namespace trackbed::coupling {

/// A deforming surface and the structure that carries it.
struct Surface {
  dem::SurfacePatch patch;
  dem::PatchContacts contacts;
  std::unique_ptr<fem::Structure> structure;
  std::vector<dem::Vec3> last_force;  ///< on the nodes, of the grain step before [N]
  std::vector<dem::Vec3> given;       ///< to the structure, at the last exchange [N]
  std::vector<dem::Vec3> owed;  ///< impulse of the grains that the structure has yet to get [N s]
  std::vector<dem::Vec3> owed_before;  ///< its value at the last exchange [N s]
  double work_predicted = 0;           ///< of the nodal forces along the nodes' motion [J]
  fem::StructureEnergy start;          ///< when the ledger was opened

  // Scratch, kept to save allocation; the path of the exchange under way.
  std::vector<fem::Vec> displacement_before, velocity_before, displacement, velocity, forces;
  double duration = 0;  ///< of the exchange [s]
};

/// Seconds spent since the start, by part of the step.
struct StepTimes {
  double motion = 0, candidates = 0, grain_contacts = 0, surface_contacts = 0, structures = 0;
  long steps = 0;       ///< of the grains
  long iterations = 0;  ///< of `iterated` exchanges, all surfaces
};

struct World {
  dem::ShapeTable shapes;
  dem::Bodies bodies;
  dem::PairMaterials materials;
  dem::Candidates candidates;
  dem::Pairs pairs;
  dem::PairForces pair_forces;
  dem::RoundForces round_forces;       ///< may stay empty where all bodies are polyhedra
  dem::ResistanceSettings resistance;  ///< of grains and rigid bodies; off unless set
  bool adaptive = false;               ///< Shao's damping after each step
  dem::AdaptiveDamping adaptive_damping;
  dem::EvaluatePatch patch_forces = nullptr;
  dem::EvaluatePatch round_patch_forces = nullptr;  ///< of spheres and dilated polyhedra
  std::vector<Surface> surfaces;
  Exchange exchange;

  double time = 0;  ///< [s]
  long step = 0;
  EnergyFlows flows;
  EnergyStores start;
  StepTimes times;
};

/// Sets the outer loads of a time: applied_force of bodies, set_load of structures, prescribed
/// velocities.
using Drive = std::function<void(World&, double time)>;

/// Sets up a deforming surface on a structure's contact surface. `shell_depth` a few overlaps [m];
/// `skirt` as in dem::make_patch.
Surface make_surface(const std::string& name, int material, double shell_depth, double skirt,
                     const dem::Vec3& period, std::unique_ptr<fem::Structure>);

/// Contacts of the grains with one surface where both are; writes the contacts, sums nothing.
void evaluate_surface(World&, Surface&, const dem::StepContext&);

/// Searches candidates and evaluates all forces where the bodies stand; to be called when a stage
/// starts or after bodies were added. Opens no step.
void prepare(World&, const dem::StepContext&);

/// One exchange: exchange.grain_steps steps of c.dt (one in a world without deforming surfaces).
/// Throws RunError when a position is no longer finite.
void advance(World&, const dem::StepContext&, const Drive&);

EnergyStores stores(const World&, const dem::Vec3& gravity);

/// Flows since open_ledger, those of the structures included.
EnergyFlows flows(const World&);

/// Starts the ledger here.
void open_ledger(World&, const dem::Vec3& gravity);

/// Touching contacts, those with deforming surfaces included.
int count_contacts(const World&);

/// Contacts per grain: each contact between grains counts for both.
double coordination(const World&);

}  // namespace trackbed::coupling
