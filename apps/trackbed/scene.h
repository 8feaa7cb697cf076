// A scene: everything a parameter file says, as plain structs in SI units. Filled and checked by
// read_scene(); nothing after it needs the file. Section and key names in the file are given in
// parameters.cc, in the same order as here.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "apps/trackbed/load_table.h"
#include "fem/rail_pad.h"

namespace trackbed::apps {

/// x across the track (along the sleeper), y along the track, z up; the subgrade's top is z = 0
/// and the box is centred at x = y = 0.
struct ContainerScene {
  std::string shape;      ///< "box" | "cylinder"
  int sides;              ///< of the prism that stands for a cylinder
  double length;          ///< in x [m]
  double width;           ///< in y [m]
  double depth;           ///< of ballast under the sleeper, design value [m]
  bool periodic;          ///< seam in y instead of walls
  bool half;              ///< by symmetry only x >= 0 is simulated, with a mirror wall at x = 0
  double shoulder_width;  ///< ballast beyond the sleeper's end at its top [m]; 0 = box filled to
                          ///< the walls
  double shoulder_slope;  ///< run over rise of the shoulder (1.75 = 1:1.75)
  double fill_height;     ///< of the ballast beside the sleeper, above the sleeper's base [m]
  double friction;        ///< grain on wall
};

/// Grains outside the part that matters: coarser, simpler, fewer.
struct ZoneScene {
  bool use;
  double margin;      ///< of the fine zone beyond the sleeper's footprint [m]
  double transition;  ///< width of the ring in which fine and coarse grains are mixed [m]
  std::string curve;  ///< outside; "scaled" = the scene's own times size_ratio
  double size_ratio;
  std::string generator;
  int vertices;  ///< of each grain outside (generator ellipsoid)
};

struct GrainScene {
  std::string generator;                          ///< one of dem::generator_names()
  int library;                                    ///< shapes in the library
  std::string shape, other_shape;                 ///< "polyhedron", "dilated", "clump", "sphere"
  double other_share;                             ///< of the library
  double dilation;                                ///< radius over sieve size
  double clump_least_radius, clump_space_factor;  ///< R_lim over the stone's width, K
  double elongation, flatness, sphericity,
      angularity;                 ///< targets of the library's means; 0 = none
  double spacing, least_face;     ///< voronoi
  std::vector<double> axes;       ///< ellipsoid, full axes
  int points_least, points_most;  ///< ellipsoid, corners of a grain
  double length_over_height, length_over_height_deviation;  ///< jin_hull
  int divisions;                                            ///< jin_hull, N_d
  double least_scale, largest_scale;                        ///< jin_hull, S_l and S_u
  std::string stones;                                       ///< files: the folder they are in
  bool hull;                                                ///< files: hulls of dented stones
  std::uint64_t seed;
  double density;            ///< [kg/m3]
  double friction;           ///< grain on grain
  std::string sieve_method;  ///< that puts grains in their class
};

struct GradationScene {
  std::string curve;                    ///< a name, or "table"
  std::vector<double> sieves, passing;  ///< of a table: [m], [%]
  double top_sieve;  ///< size of the largest grain when the curve ends below 100 % [m]
  double tolerance;  ///< per class, share of total mass
  double needle_share, flaky_share;  ///< of the mass [%]; both 0 = as the library comes
};

struct ContactScene {
  std::string law;           ///< "stored_energy" | "shao2017"
  double modulus;            ///< contact modulus of the loading stage [Pa]
  double packing_modulus;    ///< softer, while packing [Pa]
  double tangential_ratio;   ///< k_s/k_n
  std::string round_law;     ///< "hertz_mindlin" | "hertz_flat" | "sun2015" | "linear"
  double restitution;        ///< of round contacts
  double poisson;            ///< of the rock, for their tangential stiffness
  double stiffness;          ///< of the linear law [N/m]
  std::string pairs;         ///< what differs for pairs of materials, as text
  std::string damping_kind;  ///< "local" | "adaptive" | "none"
  double torsion;            ///< share of Coulomb's torsional limit; 0 = off
  double rolling;            ///< coefficient of rolling resistance; 0 = off
  double damping;            ///< local damping while loading; 0 = off
  double packing_damping;    ///< local damping while packing
  double largest_overlap;    ///< share of the grain's size at which a run stops
};

struct PackingScene {
  std::string method;      ///< "tamping" | "quasi_vibration" | "deposit"
  std::string start_from;  ///< exported packing (.csv, .off); empty = grains are drawn and poured
  std::vector<double> origin;         ///< of the scene, in packings read and exported [m]
  double target_porosity;             ///< of quasi-vibration; negative: by relative density
  double target_relative_density;     ///< 0 loosest, 1 densest
  std::vector<double> friction_path;  ///< its grain frictions, falling
  double porosity_tolerance;
  double unbalanced;        ///< force, over the mean contact force, at which such a bed is at rest
  int layers, bays;         ///< copies of the packed sample upward, and along the track
  double bulk_density;      ///< design density of the bed that sets the grain mass [kg/m3]
  double packing_friction;  ///< while dropping; < 0 = the grains' own
  double settle_time;       ///< longest time of the gravity deposit [s]
  double quiet;             ///< kinetic energy per grain over m g d at which a stage is at rest
  double plate_force;       ///< peak [N]
  double plate_frequency;   ///< [Hz]
  int plate_cycles;
  double target_density;  ///< [kg/m3] tamping stops when reached; 0 = all cycles
  double plate_thickness, plate_density;
  std::string folder;  ///< where packings are stored
  bool reuse;          ///< take a stored packing with the same inputs
};

struct SleeperScene {
  std::string type;              ///< a name of sleeper_types.h
  std::string model;             ///< "rigid" | "elastic" | "beam" (`auto` has been decided)
  std::string reduction;         ///< of an elastic one: "none" | "condensed" | "modal"
  int modes;                     ///< of a reduced one
  double length, width, height;  ///< in x, y, z [m]
  double density, modulus, poisson, friction;
  std::vector<double> elements;  ///< in x, y, z
  int order;                     ///< polynomial degree of the elements
  double pad_thickness, pad_modulus, pad_poisson, pad_density;  ///< under-sleeper pad, 0 = none
  std::vector<double> seats;                                    ///< x of the rail seats [m]
  double seat_length, seat_width;  ///< loaded area of one seat in x, y [m]
  fem::RailPad rail_pad;           ///< under each rail; stiffness 0 = none
  int freedom;       ///< of a rigid sleeper: bits of dem::Freedom, -1 = not understood
  std::string mesh;  ///< Gmsh file instead of a block; empty = block
};

struct SubgradeScene {
  std::string model;    ///< "rigid" or a name from the registry ("layered_elastic", ...)
  double element_size;  ///< largest edge of an element [m]
  int order;            ///< polynomial degree of the elements
  double friction;
  std::string reduction;                      ///< "none" | "condensed" | "modal"
  int modes;                                  ///< of a reduced one
  std::string inertia;                        ///< "on" | "off" (`auto` has been decided)
  std::string absorbing;                      ///< "none" | "sides" | "bottom" | "all"
  double damping_ratio;                       ///< of the material, share of critical; 0 = off
  std::map<std::string, std::string> values;  ///< of the model's own section: key to text
};

struct LoadingScene {
  double least, largest;  ///< total on the sleeper [N]
  double frequency;       ///< [Hz]
  int cycles;
  double ramp_time;      ///< from zero to the least load [s]
  std::string waveform;  ///< "sine" | "haversine" | "triangle" | "table"
  std::string table;     ///< file of a table
  LoadTable history;     ///< its rows
  std::string push;      ///< after the cycles: "none" | "lateral" (x) | "longitudinal" (y)
  double push_speed, push_distance, push_stiffness;  ///< [m/s], [m], of the actuator [N/m]
};

/// A test of the packed grains in place of the load cycles (grain_tests/).
struct GrainTestScene {
  std::string type;              ///< "none" | "angle_of_repose" | "direct_shear" | "triaxial"
  std::vector<double> stresses;  ///< normal or confining [Pa]
  double speed, travel;          ///< [m/s], [m]
  double shear_plane;            ///< height over that of the bed
  double strain_rate, largest_strain;
  double consolidation_time;  ///< longest [s]
  double tolerance;           ///< of stresses that are held, share
  int samples;                ///< rows of a curve
  double residual_share;      ///< of a curve, at its end
  double floor_length;        ///< beyond the lifted wall [m]
  double rest_time;           ///< longest [s]
  int planes;                 ///< of the profile
  bool on() const { return type != "none"; }
};

struct NumericsScene {
  double margin;  ///< share of the stability limit
  double packing_margin;
  std::string step_rule;      ///< "tangent" | "sun2015" | "rayleigh"
  double time_step;           ///< fixed step [s]; 0 = from margin
  double spectral_radius;     ///< of generalised-alpha at infinite frequency; 1 = Newmark
  std::string exchange;       ///< schedule of coupling/exchange.h
  int grain_steps;            ///< per exchange, with several_steps
  double exchange_tolerance;  ///< of iterated
  std::string scheme;         ///< of the structures' time integration
  std::string solver;         ///< of their linear systems
  double closure;             ///< share of the work done beyond which the run fails
  double largest_speed;       ///< of a grain [m/s]; 0 = by what is known of the scene
  double mirror_noise;        ///< relative size of a last-bit change of the start (noise floor)
};

/// Where porosity is measured and the bed is cut for pictures.
struct MeasureScene {
  std::vector<double> low, high;  ///< corners of the region [m]; empty = see the parameter
  double radius;                  ///< > 0: an upright cylinder about the region's middle [m]
  int layers;                     ///< of the porosity profile
  int horizontal_cuts, vertical_cuts;
};

/// Some bodies alone: a pair at which a run went wrong.
struct ReplayScene {
  std::string bodies;                ///< packing file; empty = an ordinary scene
  std::vector<double> motion, held;  ///< six numbers a body; indices
  int steps;
};

struct OutputScene {
  int samples_per_cycle;       ///< lines of history.csv per load cycle
  double snapshot_interval;    ///< [s]; 0 = at stage ends only
  double checkpoint_interval;  ///< wall-clock minutes between checkpoints
  int energy_interval;         ///< steps between lines of energy.csv; 0 = with history.csv
  bool structure_fields;       ///< VTU of the structures with every snapshot
};

struct Scene {
  std::string title;
  std::string name;  ///< file name without ending: names the results folder
  std::string file;
  std::map<std::string, std::string> values;  ///< every parameter as used: "Section/Key" to text
  std::vector<std::string> decisions;         ///< what `auto` came to, and why
  std::string resolved;  ///< values and decisions as a parameter file (scene.resolved.prm)
  ContainerScene container;
  GrainScene grains;
  GradationScene gradation;
  ZoneScene zones;
  ContactScene contact;
  PackingScene packing;
  SleeperScene sleeper;
  SubgradeScene subgrade;
  LoadingScene loading;
  GrainTestScene test;
  NumericsScene numerics;
  MeasureScene measures;
  ReplayScene replay;
  OutputScene output;
};

}  // namespace trackbed::apps
