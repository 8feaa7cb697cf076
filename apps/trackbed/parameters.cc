#include "apps/trackbed/parameters.h"

#include <limits>

#include "apps/trackbed/choices.h"
#include "apps/trackbed/sleeper_types.h"

namespace trackbed::apps {
namespace {

constexpr double any = std::numeric_limits<double>::infinity();

/// Collects the parameters of one section.
class Section {
 public:
  Section(std::vector<Parameter>& table, std::string name)
      : table_(table), name_(std::move(name)) {}

  void number(const char* key, const char* fallback, const char* unit, double least, double most,
              const char* meaning) {
    add(key, fallback, unit, meaning, ParameterKind::number, least, most);
  }
  void integer(const char* key, const char* fallback, double least, double most,
               const char* meaning) {
    add(key, fallback, "-", meaning, ParameterKind::integer, least, most);
  }
  void numbers(const char* key, const char* fallback, const char* unit, double least, double most,
               const char* meaning) {
    add(key, fallback, unit, meaning, ParameterKind::numbers, least, most);
  }
  void boolean(const char* key, const char* fallback, const char* meaning) {
    add(key, fallback, "-", meaning, ParameterKind::boolean, -any, any);
  }
  void text(const char* key, const char* fallback, const char* unit, const char* meaning) {
    add(key, fallback, unit, meaning, ParameterKind::text, -any, any);
  }
  void choice(const char* key, const char* fallback, std::vector<std::string> choices,
              const char* meaning) {
    add(key, fallback, "-", meaning, ParameterKind::choice, -any, any);
    table_.back().choices = std::move(choices);
  }

 private:
  void add(const char* key, const char* fallback, const char* unit, const char* meaning,
           ParameterKind kind, double least, double most) {
    table_.push_back({name_, key, fallback, unit, meaning, kind, least, most, {}});
  }
  std::vector<Parameter>& table_;
  std::string name_;
};

void add_container(Section s) {
  s.choice("Shape", "box", {"box", "cylinder"},
           "a cylinder stands upright; Length and Width are its diameter");
  s.integer("Sides", "32", 8, 256,
            "of the prism of equal area that stands for a cylinder; 32: radius within 0.4 %");
  s.number("Length", "0.6", "m", 0.01, 100, "of the box across the track (x, along the sleeper)");
  s.number("Width", "0.3", "m", 0.01, 100,
           "of the box along the track (y); a periodic bay's length");
  s.number("Ballast depth", "0.35", "m", 0.01, 5, "design depth of ballast under the sleeper");
  s.boolean("Periodic along track", "false",
            "a seam in y instead of walls: what leaves on one side comes in on the other");
  s.boolean("Half by symmetry", "false",
            "simulate x >= 0 only, with a frictionless mirror wall at x = 0");
  s.number("Shoulder width", "0", "m", 0, 5,
           "ballast beyond the sleeper's end at its top; 0 = the box is filled to its walls");
  s.number("Shoulder slope", "1.75", "-", 0, 10, "run over rise: 1.75 is a slope of 1:1.75");
  s.number("Fill height", "0.15", "m", 0, 1, "of the ballast beside the sleeper, above its base");
  s.number("Friction", "0.67", "-", 0, 10, "coefficient, grain on wall");
}

void add_grains(Section s) {
  s.choice("Generator", "voronoi", grain_generators(), "of the library of convex grains");
  s.choice("Shape", "polyhedron", grain_shapes(),
           "polyhedron; dilated: a polyhedron within a rounding; clump: Jin's stones filled with "
           "spheres; sphere");
  s.choice("Other shape", "sphere", grain_shapes(), "of a second kind of grains, see Other share");
  s.number("Other share", "0", "-", 0, 1, "of the library that has the other shape");
  s.number("Dilation", "0.05", "-", 1e-3, 0.4, "dilated: radius as a share of the sieve size");
  s.number("Clump least radius", "0.25", "-", 0.02, 0.5,
           "clump: of a sphere over the stone's width, R_lim of Jin 2017 (0.12: about 50 spheres)");
  s.number("Clump space factor", "1.3", "-", 1, 10, "clump: K of Jin 2017; more = fewer spheres");
  s.integer("Library size", "600", 1, 1e6, "shapes to draw from");
  s.number("Sphericity", "0", "-", 0, 0.999,
           "target of the library's mean (Wadell), by stretching; 0 = as generated");
  s.number("Angularity", "0", "-", 0, 2,
           "target of the mean angle of edges over a right one, by blunting; 0 = as generated");
  s.number("Elongation", "0", "-", 0, 1, "target of the mean I/L; 0 = as generated");
  s.number("Flatness", "0", "-", 0, 1, "target of the mean S/I; 0 = as generated");
  s.number("Voronoi spacing", "0.6", "-", 0, 0.8,
           "voronoi: least distance of seeds over the mean cell's edge; less = more uneven grains");
  s.number("Voronoi least face", "0.05", "-", 0, 0.5,
           "voronoi: faces below this share of the mean face are left out");
  s.numbers("Ellipsoid axes", "1, 0.8, 0.6", "-", 1e-3, 1e3, "ellipsoid: ratio of its three axes");
  s.integer("Ellipsoid least corners", "12", 4, 1000, "ellipsoid: corners of a grain, at least");
  s.integer("Ellipsoid most corners", "24", 4, 1000, "ellipsoid: corners of a grain, at most");
  s.number("Length over height", "1.6", "-", 1, 20, "jin_hull: median of L/H, log-normal");
  s.number("Length over height deviation", "0.2", "-", 0, 2,
           "jin_hull: standard deviation of ln(L/H)");
  s.integer("Divisions", "2", 1, 20, "jin_hull: parts of a box edge, N_d of Jin 2017");
  s.number("Least scale", "0.8", "-", 0.05, 10, "jin_hull: least factor of a node's radius, S_l");
  s.text("Stones", "", "-",
         "files: folder of OFF, OBJ or STL files of stones, from the scene's file; they make the "
         "library, their size does not matter");
  s.boolean("Hulls of stones", "false", "files: take the convex hull of stones that are dented");
  s.number("Largest scale", "1.2", "-", 0.05, 10,
           "jin_hull: largest factor of a node's radius, S_u");
  s.integer("Seed", "1", 0, 9.2e18, "of every random choice: the same seed gives the same packing");
  s.number("Density", "2600", "kg/m3", 1, 2e4, "of the rock (Shao 2017, Table 3)");
  s.number("Friction", "0.67", "-", 0, 10, "coefficient, grain on grain (Shao 2017, Table 3)");
  s.choice("Sieve method", "exact", sieve_methods(), "that puts a grain into its sieve class");
}

void add_gradation(Section s) {
  auto curves = gradation_curves();
  curves.push_back("table");
  s.choice("Curve", "shao2017_wide", curves, "sieve curve by name, or table to give it here");
  s.numbers("Sieves", "", "m", 1e-6, 10, "of a table: openings, rising, such as 0.025, 0.0355");
  s.numbers("Passing", "", "%", 0, 100, "of a table: mass passing each sieve, never falling");
  s.number("Top sieve", "0.071", "m", 1e-6, 10,
           "opening that the largest grains pass, where the curve ends below 100 %");
  s.number("Tolerance", "0.01", "-", 1e-6, 1,
           "largest deviation of a class from the curve, as a share of the total mass");
  s.number("Needle share", "0", "%", 0, 100,
           "of the mass, in every class: longer than 1.8 sieve sizes; with Flaky share 0 too: as "
           "it comes");
  s.number("Flaky share", "0", "%", 0, 100,
           "of the mass, in every class: thinner than 0.6 sieve sizes");
}

void add_zones(Section s) {
  auto curves = gradation_curves();
  curves.insert(curves.begin(), "scaled");
  s.boolean("Use", "false",
            "fine, angular grains under the sleeper; coarser or simpler ones outside");
  s.number("Margin", "0.1", "m", 0, 10, "of the fine zone beyond the sleeper's footprint");
  s.number("Transition", "0.06", "m", 0, 10,
           "width of the ring around it in which fine and coarse grains are mixed");
  s.choice("Curve", "scaled", curves,
           "sieve curve outside; scaled = the scene's own with sizes times Size ratio");
  s.number("Size ratio", "1.4", "-", 0.5, 10, "coarse over fine sieve sizes, of Curve = scaled");
  s.choice("Generator", "ellipsoid", grain_generators(), "of the grains outside");
  s.integer("Vertices", "8", 4, 60, "of each grain outside, with Generator = ellipsoid");
}

void add_contact(Section s) {
  s.choice("Law", "stored_energy", contact_laws(),
           "normal contact: stored_energy is conservative; shao2017 is Eq. 17 as printed");
  s.number("Contact modulus", "2e9", "Pa", 1e3, 1e13,
           "E of Eq. 17 while loading; a softer one allows larger steps and overlaps (rock: 5e10)");
  s.number("Packing modulus", "2e8", "Pa", 1e3, 1e13, "E of Eq. 17 while packing");
  s.number("Tangential ratio", "0.25", "-", 0, 10, "tangential over normal stiffness (k_s/k_n)");
  s.choice("Round law", "hertz_mindlin", round_laws(),
           "of every contact with a sphere, clump or dilated grain; Contact modulus is its E*; "
           "hertz_flat: faces of dilated grains answer by the area on which they meet");
  s.number("Restitution", "0.5", "-", 0.01, 1,
           "of round contacts, head on, by a dashpot; 1 = no dashpot");
  s.number("Poisson", "0.25", "-", 0, 0.49999,
           "of the rock: tangential over normal stiffness of round contacts, 2(1-nu)/(2-nu)");
  s.number("Stiffness", "1e6", "N/m", 1, 1e12, "of Round law = linear (Jin 2017)");
  s.text("Pairs", "", "-",
         "what differs for a pair of materials, such as grain-wall: friction 0.3, restitution 0.4; "
         "grain-sleeper: modulus 1e9. Materials: grain, wall, plate, sleeper, subgrade; values: "
         "modulus, friction, ratio, restitution, stiffness");
  s.number("Local damping", "0", "-", 0, 0.95,
           "share of the unbalanced force that opposes motion while loading; 0 = off");
  s.choice(
      "Damping", "local", {"local", "adaptive", "none"},
      "of the grains' motion: local, by Local damping and Packing damping; adaptive, global with "
      "Shao's alpha (Shao 2017, Eq. 27), in their place");
  s.number("Torsional friction", "0", "-", 0, 10,
           "share of mu F_n times the contact's mean radius that resists turning about the normal, "
           "1 = Coulomb's; grains and rigid bodies; 0 = off");
  s.number("Rolling resistance", "0", "-", 0, 10,
           "coefficient mu_r of an elastic-plastic rolling spring (Ai 2011, model C); grains and "
           "rigid bodies; 0 = off");
  s.number("Packing damping", "0.4", "-", 0, 0.95, "as Local damping, while packing");
  s.number(
      "Largest overlap", "0.2", "-", 1e-6, 0.5,
      "share of the smaller grain's size, the cube root of its volume, at which a contact's depth "
      "stops the run");
}

void add_packing_method(Section s) {
  s.choice("Method", "tamping", {"tamping", "quasi_vibration", "deposit"},
           "a plate; friction lowered until a porosity is reached (Jin 2017); gravity alone");
  s.text("Start from", "", "-",
         "exported packing (.csv or .off, trackbed pack --export) instead of drawn grains, "
         "relative to this file; empty = draw");
  s.numbers("Origin", "0, 0, 0", "m", -1e7, 1e7,
            "x, y, z of the scene's own origin (middle of the box, top of the subgrade) in the "
            "packings that are read and exported, such as in coordinates of a survey; results are "
            "about the scene's own");
  s.number("Target porosity", "-1", "-", -1, 0.999,
           "of quasi_vibration, by the height of the bed's centre of volume; "
           "negative = by relative density");
  s.number("Target relative density", "0.5", "-", 0, 1,
           "of quasi_vibration without a target porosity: between the path's loosest (0) and "
           "densest bed (1), by void ratios");
  s.numbers("Friction path", "0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0", "-", 0, 10,
            "of quasi_vibration, grain on grain: of the deposit, then lowered in turn");
  s.number("Porosity tolerance", "1e-3", "-", 1e-6, 0.1, "of the target, absolute");
  s.number("Unbalanced force", "0.01", "-", 1e-6, 1,
           "mean over the mean contact force at which a bed of the friction path, or of layers, "
           "is at rest");
  s.integer("Layers", "1", 1, 1000,
            "the bed is this many copies of a packed layer, varied, the seams settled");
  s.integer("Bays", "1", 1, 1000,
            "the same along the track, where it is periodic: a sample of Width / Bays");
}

void add_packing(Section s) {
  s.number("Bulk density", "1720", "kg/m3", 1, 2e4,
           "design density of the bed: sets the mass of grains poured (Shao 2017, Eq. 14)");
  s.number("Packing friction", "-1", "-", -1, 10,
           "grain on grain while dropping; negative = the grains' own");
  s.number("Settle time", "1.5", "s", 1e-6, 1e4, "longest time of the deposit under gravity");
  s.number("Quiet", "1e-4", "-", 1e-15, 1,
           "at rest when the kinetic energy per grain falls below this share of m g d");
  s.number("Plate force", "4e4", "N", 0, 1e9, "peak of the tamping plate (Shao 2017: 40 kN)");
  s.number("Plate frequency", "10", "Hz", 1e-3, 1e4, "of the tamping plate");
  s.integer("Plate cycles", "8", 0, 1e6, "at most; 0 = no tamping (Shao 2017: 45)");
  s.number("Target density", "1550", "kg/m3", 0, 2e4,
           "tamping ends when the bed is this dense; 0 = after all cycles (Shao 2017: 1550)");
  s.number("Plate thickness", "0.03", "m", 1e-4, 1, "of the rigid tamping plate");
  s.number("Plate density", "7850", "kg/m3", 1, 1e5, "of the rigid tamping plate");
  s.text("Folder", "results/packings", "-", "where packings are kept for other runs");
  s.boolean("Reuse", "true", "take a kept packing that was made from the same inputs");
}

void add_sleeper(Section s) {
  s.choice(
      "Type", "block", sleeper_types(),
      "sets sizes, Density, Modulus, Seats and Elements that the scene does not give; block sets "
      "nothing");
  s.choice(
      "Model", "elastic", {"rigid", "elastic", "beam", "auto"},
      "six equations of a rigid body, an FE body, or a Timoshenko beam; auto: FE where a beam of "
      "this length bends on a stiff bed");
  s.choice("Reduction", "none", reductions(),
           "of an elastic sleeper to modes: modal is cheapest, condensed keeps every static load");
  s.integer("Modes", "20", 1, 1000, "lowest elastic modes of a reduced sleeper");
  s.number("Length", "0.26", "m", 1e-3, 20, "in x, across the track");
  s.number("Width", "0.28", "m", 1e-3, 5, "in y, along the track");
  s.number("Height", "0.2", "m", 1e-3, 2, "in z");
  s.number("Density", "2800", "kg/m3", 1, 2e4, "(Shao 2017, Table 3)");
  s.number("Modulus", "4e10", "Pa", 1e3, 1e13, "Young's modulus (concrete)");
  s.number("Poisson", "0.2", "-", 0, 0.49999, "Poisson's ratio");
  s.number("Friction", "0.67", "-", 0, 10, "coefficient, grain on sleeper");
  s.numbers("Elements", "4, 4, 3", "-", 1, 1000, "in x, y and z, of an elastic sleeper");
  s.integer("Order", "2", 1, 2, "polynomial degree of the elements");
  s.number("Pad thickness", "0", "m", 0, 0.2, "of an under-sleeper pad within Height; 0 = none");
  s.number("Pad modulus", "5e6", "Pa", 1e3, 1e13, "Young's modulus of the pad");
  s.number("Pad Poisson", "0.4", "-", 0, 0.49999, "Poisson's ratio of the pad");
  s.number("Pad density", "1000", "kg/m3", 1, 2e4, "of the pad");
  s.numbers("Seats", "0", "m", -10, 10, "x of the rail seats; the load is shared equally");
  s.number("Seat length", "0.15", "m", 1e-3, 5, "loaded area of a seat, in x");
  s.number("Seat width", "0.15", "m", 1e-3, 5, "loaded area of a seat, in y");
  s.number("Pad stiffness", "0", "N/m", 0, 1e13,
           "of the rail pad between a rail seat and the rail, where the load acts; 0 = none");
  s.number("Pad damping", "0", "N s/m", 0, 1e9, "of the rail pad, beside its spring");
  s.text("Degrees of freedom", "six", "-",
         "of a rigid sleeper: six, vertical (Sun 2015), or a list with z of x, y, z, turn x, "
         "turn y, turn z; the others stay exactly where they are");
  s.text("Mesh", "", "-",
         "Gmsh file of an elastic sleeper with the outer sizes above, relative to this file; "
         "empty = block");
}

void add_subgrade(Section s) {
  s.choice("Model", "layered_elastic", subgrade_models(),
           "what carries the ballast; each model but rigid has a section of its own");
  s.number("Element size", "0.1", "m", 1e-4, 10, "largest edge of an element");
  s.integer("Order", "1", 1, 2, "polynomial degree of the elements");
  s.number("Friction", "0.67", "-", 0, 10, "coefficient, grain on subgrade");
  s.choice("Reduction", "none", reductions(),
           "of finite elements to modes; condensed keeps every static load on the surface");
  s.integer("Modes", "20", 1, 1000, "lowest elastic modes of a reduced subgrade");
  s.choice(
      "Inertia", "on", {"on", "off", "auto"},
      "of the elastic subgrade; off: a static answer at each exchange, which is then iterated; "
      "auto: off where the load's harmonics stay below a quarter of the first mode");
  s.choice(
      "Absorbing", "none", {"none", "sides", "bottom", "all"},
      "boundaries with dashpots and springs that let waves out, instead of rollers and a fixed "
      "base");
  s.number("Damping ratio", "0", "-", 0, 0.5,
           "of the elastic subgrade's material, share of critical at the load's frequency and at "
           "ten times it (Rayleigh); soils at small strain have 0.01 to 0.05; 0 = off");
}

void add_loading(Section s) {
  s.number("Least", "3e3", "N", 0, 1e9, "total force on the sleeper at the trough");
  s.number("Largest", "8e4", "N", 0, 1e9, "total force on the sleeper at the peak");
  s.number("Frequency", "10", "Hz", 1e-6, 1e4, "of the load");
  s.integer("Cycles", "10", 0, 1e9, "load cycles (Shao 2017: 80)");
  s.number("Ramp time", "0.05", "s", 0, 1e4, "from no load to Least");
  s.choice(
      "Waveform", "sine", waveforms(),
      "from Least to Largest and back: sine and haversine are (1 - cos)/2, triangle has straight "
      "flanks; table takes it from a file instead");
  s.text("Table", "", "-",
         "CSV file with the columns time_s and load_N, one cycle, relative to this file");
  s.choice(
      "Push", "none", {"none", "lateral", "longitudinal"},
      "after the cycles, under the least load: the sleeper's resistance along x or y (push.csv)");
  s.number("Push speed", "0.01", "m/s", 1e-6, 10, "of the actuator");
  s.number("Push distance", "0.005", "m", 1e-6, 1, "of the actuator");
  s.number("Push stiffness", "1e7", "N/m", 1e3, 1e12,
           "of the actuator between its drive and the sleeper; lowered to what a light sleeper "
           "bears at the run's time step");
}

void add_grain_test(Section s) {
  s.choice(
      "Type", "none", grain_tests(),
      "test of the packed grains in place of the load cycles, to calibrate them (strength.csv): "
      "angle_of_repose, x_max lifted; direct_shear, the upper half of the box moved along x; "
      "triaxial, frictionless walls without gravity");
  s.numbers("Stresses", "25e3, 50e3, 100e3", "Pa", 1, 1e9,
            "normal (direct_shear) or confining (triaxial), each from the same packing");
  s.number("Speed", "0.02", "m/s", 1e-6, 10,
           "of the upper half box (direct_shear) or of the lifted wall (angle_of_repose)");
  s.number("Travel", "0.03", "m", 1e-6, 10, "of the upper half box along x (direct_shear)");
  s.number("Shear plane", "0.5", "-", 0.05, 0.95,
           "its height over the height of the packed bed (direct_shear)");
  s.number("Strain rate", "0.1", "1/s", 1e-6, 100, "axial (triaxial), of the consolidated height");
  s.number("Largest strain", "0.15", "-", 1e-6, 0.5, "axial, at which a triaxial test ends");
  s.number("Consolidation time", "0.5", "s", 1e-6, 1e4,
           "longest, until each stress is held within Tolerance and the unbalanced force is below "
           "Packing/Unbalanced force");
  s.number(
      "Tolerance", "0.02", "-", 1e-9, 0.5,
      "of the stresses that servos hold, as a share of them; what was kept is in strength.csv");
  s.integer("Samples", "100", 10, 1e5,
            "rows of a curve, each the mean over its part of the travel or strain");
  s.number("Residual share", "0.2", "-", 0.01, 1, "of the curve at its end that is residual");
  s.number("Floor length", "0.4", "m", 0.01, 20,
           "beyond the lifted wall (angle_of_repose); it ends at a wall");
  s.number("Rest time", "4", "s", 1e-6, 1e4,
           "longest, until the heap lies still by Packing/Quiet (angle_of_repose)");
  s.integer(
      "Profile planes", "0", 0, 1000,
      "vertical cuts whose outlines make the profile (angle_of_repose); 0 = one a mean grain");
}

void add_numerics(Section s) {
  s.number("Margin", "0.2", "-", 1e-4, 1, "time step as a share of the stability limit");
  s.number("Packing margin", "0.3", "-", 1e-4, 1, "the same while packing");
  s.choice("Time step rule", "tangent", {"tangent", "sun2015", "rayleigh"},
           "tangent: margins of the true limit; sun2015: T_min/40 of the lightest grain; rayleigh: "
           "a wave's time over the smallest grain; refused when over the limit");
  s.number("Time step", "0", "s", 0, 1, "fixed step of all stages; 0 = from the margins");
  s.number("Spectral radius", "0.9", "-", 0, 1,
           "of generalised-alpha at infinite frequency; 1 = Newmark's trapezoidal rule");
  s.choice(
      "Structure scheme", "automatic", time_schemes(),
      "time integration of finite elements: automatic is explicit where mass is lumped and the "
      "step allows, else generalised_alpha; reduced ones are exact in their modes");
  s.choice("Linear solver", "automatic", linear_solvers(),
           "of finite elements: automatic is direct up to 60000 unknowns, else cg_gamg; materials "
           "with history take GMRES for cg");
  s.choice("Exchange", "predicted", exchange_schedules(),
           "of forces and motion between grains and structures: predicted, one force on both sides "
           "at each step; explicit, structures without a solve; several_steps; iterated; lagged, "
           "only to show what a delay does");
  s.integer("Grain steps per exchange", "1", 1, 1000, "with Exchange = several_steps");
  s.number("Exchange tolerance", "1e-8", "-", 1e-13, 0.1,
           "of Exchange = iterated: what remains to move over the deepest overlap");
  s.number("Closure", "0.01", "-", 1e-12, 1,
           "share of the work done beyond which an open energy ledger fails the run");
  s.number(
      "Largest speed", "0", "m/s", 0, 1e5,
      "of a grain, at which a run stops; 0 = three times what falling from the bed's top, plate "
      "and sleeper, and the strongest contact so far explain");
  s.number("Mirror noise", "0", "-", 0, 1e-6,
           "relative change of the start to show the noise floor; 0 = off");
}

void add_measures(Section s) {
  s.numbers(
      "Low", "", "m", -100, 100,
      "x, y, z of the region where porosity is measured; empty: the container (with shoulders "
      "the sleeper's length) from the subgrade to the bed's top");
  s.numbers("High", "", "m", -100, 100, "the opposite corner; empty: see Low");
  s.number("Radius", "0", "m", 0, 100,
           "of an upright cylinder about the region's middle instead of the box; 0 = the box");
  s.integer("Layers", "10", 1, 1000, "of the porosity profile, porosity.csv");
  s.integer("Horizontal cuts", "2", 0, 100, "virtual slices through the region, sections.csv");
  s.integer("Vertical cuts", "1", 0, 100, "across the track, sections.csv");
}

void add_replay(Section s) {
  s.text(
      "Bodies", "", "-",
      "packing (.csv) of bodies that move alone, without walls, sleeper or load: offender.prm of "
      "a run that went wrong; empty = no replay");
  s.numbers("Motion", "", "m/s, rad/s", -any, any,
            "v_x, v_y, v_z and omega_x, omega_y, omega_z of each body; empty = at rest");
  s.numbers("Held", "", "-", 0, 1e9, "numbers, from 0, of the bodies that keep this motion");
  s.integer("Steps", "400", 1, 1e9, "of Numerics/Time step");
}

void add_output(Section s) {
  s.integer("Samples per cycle", "100", 4, 1e6, "lines of history.csv in a load cycle");
  s.number("Snapshot interval", "0.05", "s", 0, 1e6, "0 = at the stages' ends only");
  s.number("Checkpoint interval", "5", "min", 0, 1e5,
           "of wall-clock time; 0 = at stages' ends only");
  s.integer("Energy interval", "0", 0, 1e9,
            "steps between lines of energy.csv besides those of history.csv; 0 = none besides");
  s.boolean("Structure fields", "true", "write the structures' deformation with every snapshot");
}

}  // namespace

std::vector<Parameter> scene_parameters() {
  std::vector<Parameter> table;
  Section(table, "").text("Title", "Ballast box", "-", "heads the report");
  add_container({table, "Container"});
  add_grains({table, "Grains"});
  add_gradation({table, "Gradation"});
  add_zones({table, "Zones"});
  add_contact({table, "Contact"});
  add_packing_method({table, "Packing"});
  add_packing({table, "Packing"});
  add_sleeper({table, "Sleeper"});
  add_subgrade({table, "Subgrade"});
  const auto models = subgrade_parameters();
  table.insert(table.end(), models.begin(), models.end());
  add_loading({table, "Loading"});
  add_grain_test({table, "Test"});
  add_numerics({table, "Numerics"});
  add_measures({table, "Measures"});
  add_replay({table, "Replay"});
  add_output({table, "Output"});
  return table;
}

}  // namespace trackbed::apps
