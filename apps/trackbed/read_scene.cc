#include "apps/trackbed/read_scene.h"

#include <filesystem>
#include <set>

#include "apps/trackbed/check_grain_test.h"
#include "apps/trackbed/check_packing.h"
#include "apps/trackbed/check_scene.h"
#include "apps/trackbed/check_structures.h"
#include "apps/trackbed/choices.h"
#include "apps/trackbed/decide.h"
#include "apps/trackbed/freedom.h"
#include "apps/trackbed/inertia.h"
#include "apps/trackbed/parameter_text.h"
#include "apps/trackbed/parameter_values.h"
#include "apps/trackbed/parameters.h"
#include "apps/trackbed/scene_text.h"
#include "apps/trackbed/sleeper_types.h"

namespace trackbed::apps {
namespace {

using Values = ParameterValues;

ContainerScene container(const Values& v) {
  ContainerScene c{};
  c.shape = v.text("Container/Shape");
  c.sides = static_cast<int>(v.integer("Container/Sides"));
  c.length = v.number("Container/Length");
  c.width = v.number("Container/Width");
  c.depth = v.number("Container/Ballast depth");
  c.periodic = v.boolean("Container/Periodic along track");
  c.half = v.boolean("Container/Half by symmetry");
  c.shoulder_width = v.number("Container/Shoulder width");
  c.shoulder_slope = v.number("Container/Shoulder slope");
  c.fill_height = v.number("Container/Fill height");
  c.friction = v.number("Container/Friction");
  return c;
}

GrainScene grains(const Values& v) {
  GrainScene g{};
  g.generator = v.text("Grains/Generator");
  g.shape = v.text("Grains/Shape");
  g.other_shape = v.text("Grains/Other shape");
  g.other_share = v.number("Grains/Other share");
  g.dilation = v.number("Grains/Dilation");
  g.clump_least_radius = v.number("Grains/Clump least radius");
  g.clump_space_factor = v.number("Grains/Clump space factor");
  g.library = static_cast<int>(v.integer("Grains/Library size"));
  g.elongation = v.number("Grains/Elongation");
  g.flatness = v.number("Grains/Flatness");
  g.sphericity = v.number("Grains/Sphericity");
  g.angularity = v.number("Grains/Angularity");
  g.spacing = v.number("Grains/Voronoi spacing");
  g.least_face = v.number("Grains/Voronoi least face");
  g.axes = v.numbers("Grains/Ellipsoid axes");
  g.points_least = static_cast<int>(v.integer("Grains/Ellipsoid least corners"));
  g.points_most = static_cast<int>(v.integer("Grains/Ellipsoid most corners"));
  g.length_over_height = v.number("Grains/Length over height");
  g.length_over_height_deviation = v.number("Grains/Length over height deviation");
  g.divisions = static_cast<int>(v.integer("Grains/Divisions"));
  g.least_scale = v.number("Grains/Least scale");
  g.largest_scale = v.number("Grains/Largest scale");
  g.stones = v.text("Grains/Stones");
  g.hull = v.boolean("Grains/Hulls of stones");
  g.seed = static_cast<std::uint64_t>(v.integer("Grains/Seed"));
  g.density = v.number("Grains/Density");
  g.friction = v.number("Grains/Friction");
  g.sieve_method = v.text("Grains/Sieve method");
  return g;
}

GradationScene gradation(const Values& v) {
  GradationScene g{};
  g.curve = v.text("Gradation/Curve");
  g.sieves = v.numbers("Gradation/Sieves");
  g.passing = v.numbers("Gradation/Passing");
  g.top_sieve = v.number("Gradation/Top sieve");
  g.tolerance = v.number("Gradation/Tolerance");
  g.needle_share = v.number("Gradation/Needle share");
  g.flaky_share = v.number("Gradation/Flaky share");
  return g;
}

ZoneScene zones(const Values& v) {
  ZoneScene z{};
  z.use = v.boolean("Zones/Use");
  z.margin = v.number("Zones/Margin");
  z.transition = v.number("Zones/Transition");
  z.curve = v.text("Zones/Curve");
  z.size_ratio = v.number("Zones/Size ratio");
  z.generator = v.text("Zones/Generator");
  z.vertices = static_cast<int>(v.integer("Zones/Vertices"));
  return z;
}

ContactScene contact(const Values& v) {
  ContactScene c{};
  c.law = v.text("Contact/Law");
  c.modulus = v.number("Contact/Contact modulus");
  c.packing_modulus = v.number("Contact/Packing modulus");
  c.tangential_ratio = v.number("Contact/Tangential ratio");
  c.damping_kind = v.text("Contact/Damping");
  c.torsion = v.number("Contact/Torsional friction");
  c.rolling = v.number("Contact/Rolling resistance");
  c.round_law = v.text("Contact/Round law");
  c.restitution = v.number("Contact/Restitution");
  c.poisson = v.number("Contact/Poisson");
  c.stiffness = v.number("Contact/Stiffness");
  c.pairs = v.text("Contact/Pairs");
  c.damping = v.number("Contact/Local damping");
  c.packing_damping = v.number("Contact/Packing damping");
  c.largest_overlap = v.number("Contact/Largest overlap");
  return c;
}

PackingScene packing(const Values& v) {
  PackingScene p{};
  p.method = v.text("Packing/Method");
  p.start_from = v.text("Packing/Start from");
  p.origin = v.numbers("Packing/Origin");
  p.target_porosity = v.number("Packing/Target porosity");
  p.target_relative_density = v.number("Packing/Target relative density");
  p.friction_path = v.numbers("Packing/Friction path");
  p.porosity_tolerance = v.number("Packing/Porosity tolerance");
  p.unbalanced = v.number("Packing/Unbalanced force");
  p.layers = static_cast<int>(v.integer("Packing/Layers"));
  p.bays = static_cast<int>(v.integer("Packing/Bays"));
  p.bulk_density = v.number("Packing/Bulk density");
  p.packing_friction = v.number("Packing/Packing friction");
  p.settle_time = v.number("Packing/Settle time");
  p.quiet = v.number("Packing/Quiet");
  p.plate_force = v.number("Packing/Plate force");
  p.plate_frequency = v.number("Packing/Plate frequency");
  p.plate_cycles = static_cast<int>(v.integer("Packing/Plate cycles"));
  p.target_density = v.number("Packing/Target density");
  p.plate_thickness = v.number("Packing/Plate thickness");
  p.plate_density = v.number("Packing/Plate density");
  p.folder = v.text("Packing/Folder");
  p.reuse = v.boolean("Packing/Reuse");
  return p;
}

SleeperScene sleeper(const Values& v) {
  SleeperScene s{};
  s.type = v.text("Sleeper/Type");
  s.model = v.text("Sleeper/Model");
  s.reduction = v.text("Sleeper/Reduction");
  s.modes = static_cast<int>(v.integer("Sleeper/Modes"));
  s.length = v.number("Sleeper/Length");
  s.width = v.number("Sleeper/Width");
  s.height = v.number("Sleeper/Height");
  s.density = v.number("Sleeper/Density");
  s.modulus = v.number("Sleeper/Modulus");
  s.poisson = v.number("Sleeper/Poisson");
  s.friction = v.number("Sleeper/Friction");
  s.elements = v.numbers("Sleeper/Elements");
  s.order = static_cast<int>(v.integer("Sleeper/Order"));
  s.pad_thickness = v.number("Sleeper/Pad thickness");
  s.pad_modulus = v.number("Sleeper/Pad modulus");
  s.pad_poisson = v.number("Sleeper/Pad Poisson");
  s.pad_density = v.number("Sleeper/Pad density");
  s.seats = v.numbers("Sleeper/Seats");
  s.seat_length = v.number("Sleeper/Seat length");
  s.seat_width = v.number("Sleeper/Seat width");
  s.rail_pad = {v.number("Sleeper/Pad stiffness"), v.number("Sleeper/Pad damping")};
  s.freedom = freedom_of(v.text("Sleeper/Degrees of freedom"));
  s.mesh = v.text("Sleeper/Mesh");
  return s;
}

SubgradeScene subgrade(const Values& v) {
  SubgradeScene s{};
  s.model = v.text("Subgrade/Model");
  s.element_size = v.number("Subgrade/Element size");
  s.order = static_cast<int>(v.integer("Subgrade/Order"));
  s.friction = v.number("Subgrade/Friction");
  s.reduction = v.text("Subgrade/Reduction");
  s.modes = static_cast<int>(v.integer("Subgrade/Modes"));
  s.inertia = v.text("Subgrade/Inertia");
  s.absorbing = v.text("Subgrade/Absorbing");
  s.damping_ratio = v.number("Subgrade/Damping ratio");
  const std::string section = "Subgrade/" + s.model;
  for (const auto& p : subgrade_parameters())
    if (p.section == section) s.values[p.key] = v.text(parameter_path(p));
  return s;
}

LoadingScene loading(const Values& v) {
  LoadingScene l{};
  l.least = v.number("Loading/Least");
  l.largest = v.number("Loading/Largest");
  l.frequency = v.number("Loading/Frequency");
  l.cycles = static_cast<int>(v.integer("Loading/Cycles"));
  l.ramp_time = v.number("Loading/Ramp time");
  l.waveform = v.text("Loading/Waveform");
  l.table = v.text("Loading/Table");
  if (l.waveform == "table" && !l.table.empty()) {
    l.history = read_load_table(l.table);
    l.frequency = 1 / l.history.period();
    l.least = l.history.load.front();
    l.largest = l.history.at(l.history.peak() * l.history.period());
  }
  l.push = v.text("Loading/Push");
  l.push_speed = v.number("Loading/Push speed");
  l.push_distance = v.number("Loading/Push distance");
  l.push_stiffness = v.number("Loading/Push stiffness");
  return l;
}

GrainTestScene grain_test(const Values& v) {
  GrainTestScene t{};
  t.type = v.text("Test/Type");
  t.stresses = v.numbers("Test/Stresses");
  t.speed = v.number("Test/Speed");
  t.travel = v.number("Test/Travel");
  t.shear_plane = v.number("Test/Shear plane");
  t.strain_rate = v.number("Test/Strain rate");
  t.largest_strain = v.number("Test/Largest strain");
  t.consolidation_time = v.number("Test/Consolidation time");
  t.tolerance = v.number("Test/Tolerance");
  t.samples = static_cast<int>(v.integer("Test/Samples"));
  t.residual_share = v.number("Test/Residual share");
  t.floor_length = v.number("Test/Floor length");
  t.rest_time = v.number("Test/Rest time");
  t.planes = static_cast<int>(v.integer("Test/Profile planes"));
  return t;
}

NumericsScene numerics(const Values& v) {
  NumericsScene n{};
  n.margin = v.number("Numerics/Margin");
  n.packing_margin = v.number("Numerics/Packing margin");
  n.step_rule = v.text("Numerics/Time step rule");
  n.time_step = v.number("Numerics/Time step");
  n.spectral_radius = v.number("Numerics/Spectral radius");
  n.exchange = v.text("Numerics/Exchange");
  n.grain_steps = static_cast<int>(v.integer("Numerics/Grain steps per exchange"));
  n.exchange_tolerance = v.number("Numerics/Exchange tolerance");
  n.scheme = v.text("Numerics/Structure scheme");
  n.solver = v.text("Numerics/Linear solver");
  n.closure = v.number("Numerics/Closure");
  n.largest_speed = v.number("Numerics/Largest speed");
  n.mirror_noise = v.number("Numerics/Mirror noise");
  return n;
}

MeasureScene measures(const Values& v) {
  MeasureScene m{};
  m.low = v.numbers("Measures/Low");
  m.high = v.numbers("Measures/High");
  m.radius = v.number("Measures/Radius");
  m.layers = static_cast<int>(v.integer("Measures/Layers"));
  m.horizontal_cuts = static_cast<int>(v.integer("Measures/Horizontal cuts"));
  m.vertical_cuts = static_cast<int>(v.integer("Measures/Vertical cuts"));
  return m;
}

ReplayScene replay(const Values& v) {
  ReplayScene r{};
  r.bodies = v.text("Replay/Bodies");
  r.motion = v.numbers("Replay/Motion");
  r.held = v.numbers("Replay/Held");
  r.steps = static_cast<int>(v.integer("Replay/Steps"));
  return r;
}

OutputScene output(const Values& v) {
  OutputScene o{};
  o.samples_per_cycle = static_cast<int>(v.integer("Output/Samples per cycle"));
  o.snapshot_interval = v.number("Output/Snapshot interval");
  o.checkpoint_interval = v.number("Output/Checkpoint interval");
  o.energy_interval = static_cast<int>(v.integer("Output/Energy interval"));
  o.structure_fields = v.boolean("Output/Structure fields");
  return o;
}

/// Files are given relative to the scene's file; from here on they are absolute, so that
/// scene.resolved.prm can be run from anywhere.
void make_absolute(std::vector<SceneEntry>& entries) {
  namespace fs = std::filesystem;
  const std::set<std::string> files{"Mesh", "Stones", "Table", "Start from", "Bodies"};
  for (auto& entry : entries)
    if (files.count(entry.key) > 0 && !entry.value.empty() && fs::path(entry.value).is_relative()) {
      const auto folder = entry.line > 0 ? fs::path(entry.file).parent_path() : fs::path();
      entry.value = fs::absolute(folder / entry.value).lexically_normal().string();
    }
}

}  // namespace

Scene read_scene(const std::string& file, const std::vector<std::string>& overrides) {
  auto entries = read_scene_text(file);
  for (const auto& text : overrides) entries.push_back(parse_override(text));
  make_absolute(entries);
  apply_sleeper_type(entries);
  const Values values(scene_parameters(), entries);
  Scene scene{};
  scene.title = values.text("Title");
  scene.name = std::filesystem::path(file).stem().string();
  scene.file = file;
  scene.values = values.all();
  scene.resolved = values.printed();
  scene.container = container(values);
  scene.grains = grains(values);
  scene.gradation = gradation(values);
  scene.zones = zones(values);
  scene.contact = contact(values);
  scene.packing = packing(values);
  scene.sleeper = sleeper(values);
  scene.subgrade = subgrade(values);
  scene.loading = loading(values);
  scene.test = grain_test(values);
  scene.numerics = numerics(values);
  scene.measures = measures(values);
  scene.replay = replay(values);
  scene.output = output(values);
  decide(scene);
  check_scene(scene, values);
  check_grain_test(scene, values);
  check_packing(scene, values);
  check_structures(scene, values);
  decide_inertia(scene, values);
  for (const std::string& decision : scene.decisions)
    scene.resolved += "# automatic: " + decision + "\n";
  return scene;
}

}  // namespace trackbed::apps
