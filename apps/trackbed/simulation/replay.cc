#include "apps/trackbed/simulation/replay.h"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "apps/trackbed/files.h"
#include "apps/trackbed/simulation/materials.h"
#include "base/error.h"
#include "coupling/edit.h"
#include "dem/contact/restitution.h"
#include "dem/packing/packing_file.h"

namespace trackbed::apps {
namespace {

constexpr int kSteps = 400;  // four times what lies between two looks at a run's state

bool finite(const Offender& o) {
  return o.x.allFinite() && o.q.coeffs().allFinite() && o.v.allFinite() && o.omega.allFinite();
}

void write_bodies(const dem::PackedGrains& pair, const std::string& stem) {
  namespace fs = std::filesystem;
  const dem::DistinctShapes shapes = dem::distinct_shapes(pair);
  std::error_code failed;
  fs::create_directories(stem + "_shapes", failed);
  if (failed) throw RunError(stem + "_shapes: cannot be made: " + failed.message());
  for (std::size_t k = 0; k < shapes.first_of.size(); ++k) {
    const dem::ShapeFile file = dem::shape_file(pair.shape[shapes.first_of[k]]);
    write_aside_then_rename(stem + "_shapes/" + std::to_string(k) + file.ending, file.text);
  }
  write_aside_then_rename(stem + ".csv", dem::packing_csv_text(pair, shapes.shape_of));
}

std::string section(const std::string& name, const std::string& keys) {
  return "\nsubsection " + name + "\n" + keys + "end\n";
}

void place_bodies(Run& run) {
  const ReplayScene& r = run.scene.replay;
  const dem::PackedGrains g = dem::read_packing(r.bodies);
  coupling::add_grains(run.world, g.shape, g.centre, g.turn, run.scene.grains.density, kGrain);
  dem::Bodies& b = run.world.bodies;
  const auto refuse = [&](const char* key, const std::string& why) {
    throw InputError(std::string("Replay/") + key + ": " + why + " (" + std::to_string(b.grains) +
                     " bodies in " + r.bodies + ")");
  };
  if (!r.motion.empty() && r.motion.size() != 6 * static_cast<std::size_t>(b.grains))
    refuse("Motion", "six numbers a body are needed, or none");
  for (const double i : r.held) {
    if (i != std::floor(i) || i >= b.grains) refuse("Held", "numbers of bodies from 0 are needed");
    b.freedom[static_cast<int>(i)] = dem::kFixed;
  }
  for (int i = 0; i < b.grains && !r.motion.empty(); ++i) {
    const double* m = &r.motion[6 * i];
    b.v[i] = {m[0], m[1], m[2]};
    dem::set_spin(b, i, {m[3], m[4], m[5]});
  }
}

}  // namespace

Offender offender_of(const Run& run, const dem::Bodies& state, int i) {
  return {run.world.shapes.shape(state.shape[i]),
          state.material[i],
          state.x[i],
          state.v[i],
          state.omega[i],
          state.q[i],
          i >= state.grains};
}

Offender surface_at(const Run& run, const coupling::Surface& s, int contact, double ago) {
  const dem::PatchContacts& k = s.contacts;
  const dem::Bodies& b = run.world.bodies;
  dem::Vec3 velocity = dem::Vec3::Zero();
  double borne = 0;
  for (const auto& [node, force] : k.nodal[contact]) {
    velocity += force.norm() * s.patch.velocity[node];
    borne += force.norm();
  }
  if (borne > 0) velocity /= borne;
  const double edge = 4 * run.world.shapes.shape(b.shape[k.grain[contact]]).radius;
  const dem::Vec3 normal = k.normal_force[contact].normalized();
  Offender o;
  o.shape = dem::make_grain_shape(dem::make_box(dem::Vec3::Constant(edge)));
  o.material = s.patch.material;
  o.v = velocity, o.omega = dem::Vec3::Zero();
  o.q = dem::Quat::FromTwoVectors(dem::Vec3::UnitZ(), normal) * o.shape.turn;
  o.x = k.point[contact] - ago * velocity - edge / 2 * normal;
  o.held = true;
  return o;
}

std::string write_offender(const Run& run, const Stage& stage, const Offender& a, const Offender& b,
                           const std::string& who, const std::string& folder) {
  if (!finite(a) || !finite(b)) return "";
  const coupling::World& w = run.world;
  dem::PackedGrains pair;
  pair.add(a.shape, a.x, a.q);
  pair.add(b.shape, b.x + dem::nearest_image(a.x, b.x, run.layout.period), b.q);
  for (dem::GrainShape& s : pair.shape)  // of a wall, plate or surface no sieve size is known
    if (!(s.sieve_size > 0)) s.sieve_size = std::cbrt(s.volume);
  std::ostringstream motion, held;
  motion.precision(17);
  for (const Offender* o : {&a, &b}) {
    motion << (o == &a ? "" : ", ") << o->v.x() << ", " << o->v.y() << ", " << o->v.z() << ", "
           << o->omega.x() << ", " << o->omega.y() << ", " << o->omega.z();
    if (o->held) held << (held.tellp() > 0 ? ", " : "") << (o == &a ? 0 : 1);
  }
  const std::string stem = folder + "/offender";
  try {
    write_bodies(pair, stem);
  } catch (const InputError&) {  // a union of polyhedra
    return "";
  }

  // The contact as it was between these two materials.
  const dem::PairMaterial& m = w.materials(a.material, b.material);
  std::ostringstream out;
  out.precision(17);
  const auto set = [](const std::string& key, const auto& value) {
    std::ostringstream line;
    line.precision(17);
    line << "  set " << key << " = " << value << "\n";
    return line.str();
  };
  out << "# " << who << " of a run that went wrong in stage '" << stage.name << "' at step "
      << w.step << ", alone.\nset Title = Offender\n";
  const auto& values = run.scene.values;
  std::string contact =
      set("Contact modulus", m.modulus) + set("Tangential ratio", m.tangential_ratio) +
      set("Restitution", dem::restitution_for_damping(run.scene.contact.round_law, m.damping)) +
      (m.stiffness > 0 ? set("Stiffness", m.stiffness) : "") +
      set("Local damping", run.scene.contact.damping_kind == "local" ? stage.damping : 0.0);
  for (const char* key : {"Law", "Round law", "Poisson", "Damping", "Torsional friction",
                          "Rolling resistance", "Largest overlap"})
    contact += set(key, values.at(std::string("Contact/") + key));
  out << section("Contact", contact)
      << section("Grains",
                 set("Density", values.at("Grains/Density")) + set("Friction", m.friction))
      << section("Numerics", set("Time step", run.stage.dt) +
                                 set("Largest speed", values.at("Numerics/Largest speed")))
      << section("Replay", set("Bodies", "offender.csv") + set("Motion", motion.str()) +
                               set("Held", held.str()) + set("Steps", kSteps));
  write_aside_then_rename(stem + ".prm", out.str());
  return stem + ".prm";
}

Stage replay_stage(const Scene& s) {
  Stage stage = bed_stage(s, "replay", s.replay.steps * s.numerics.time_step, s.contact.damping);
  stage.enter = place_bodies;
  return stage;
}

}  // namespace trackbed::apps
