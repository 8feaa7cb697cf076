#include "coupling/checkpoint.h"

#include "base/error.h"

namespace trackbed::coupling {
namespace {

// One visitor a struct, for both directions.

template <class A>
void visit(A& archive, dem::Bodies& b) {
  archive("bodies/grains", b.grains);
  archive("bodies/x", b.x), archive("bodies/q", b.q), archive("bodies/v", b.v);
  archive("bodies/L", b.L), archive("bodies/omega", b.omega), archive("bodies/turn", b.turn);
  archive("bodies/force", b.force), archive("bodies/torque", b.torque);
  archive("bodies/applied_force", b.applied_force);
  archive("bodies/mass", b.mass), archive("bodies/inertia", b.inertia);
  archive("bodies/shape", b.shape), archive("bodies/material", b.material);
  archive("bodies/freedom", b.freedom);
  // R follows from q, but not to the last bit in code compiled for another processor.
  std::vector<dem::Vec3> columns;
  for (const dem::Mat3& R : b.R) columns.insert(columns.end(), {R.col(0), R.col(1), R.col(2)});
  archive("bodies/R", columns);
  b.R.resize(columns.size() / 3);
  for (std::size_t i = 0; i < b.R.size(); ++i)
    b.R[i] << columns[3 * i], columns[3 * i + 1], columns[3 * i + 2];
}

// All shapes in one set of arrays: their bodies, then their parts' cores.
struct FlatShapes {
  std::vector<int> vertices, faces, face_sizes, loops, parts;
  std::vector<dem::Vec3> vertex, inertia, origin;
  std::vector<dem::Quat> turn;
  std::vector<double> volume, radius, sieve_size, part_radius, crown, mean_square;
};

template <class A>
void visit(A& archive, FlatShapes& s) {
  archive("shapes/vertices", s.vertices), archive("shapes/faces", s.faces);
  archive("shapes/face_sizes", s.face_sizes), archive("shapes/loops", s.loops);
  archive("shapes/vertex", s.vertex), archive("shapes/inertia", s.inertia);
  archive("shapes/origin", s.origin), archive("shapes/turn", s.turn);
  archive("shapes/volume", s.volume), archive("shapes/radius", s.radius);
  archive("shapes/sieve_size", s.sieve_size);
  archive("shapes/parts", s.parts), archive("shapes/part_radius", s.part_radius);
  archive("shapes/crown", s.crown), archive("shapes/mean_square", s.mean_square);
}

void append(const dem::Polyhedron& p, FlatShapes& f) {
  f.vertices.push_back(static_cast<int>(p.vertices.size()));
  f.faces.push_back(static_cast<int>(p.faces.size()));
  f.vertex.insert(f.vertex.end(), p.vertices.begin(), p.vertices.end());
  for (const auto& face : p.faces) {
    f.face_sizes.push_back(static_cast<int>(face.size()));
    f.loops.insert(f.loops.end(), face.begin(), face.end());
  }
}

// Reads the polyhedra in the order they were appended.
struct PolyhedronReader {
  const FlatShapes& f;
  std::size_t polyhedron = 0, vertex = 0, face = 0, loop = 0;
  dem::Polyhedron next() {
    dem::Polyhedron p;
    for (int i = 0; i < f.vertices[polyhedron]; ++i) p.vertices.push_back(f.vertex[vertex++]);
    for (int i = 0; i < f.faces[polyhedron]; ++i) {
      p.faces.emplace_back();
      for (int j = 0; j < f.face_sizes[face]; ++j) p.faces.back().push_back(f.loops[loop++]);
      ++face;
    }
    ++polyhedron;
    return p;
  }
};

FlatShapes flatten(const dem::ShapeTable& table) {
  FlatShapes f;
  for (int k = 0; k < table.size(); ++k) {
    const dem::GrainShape& s = table.shape(k);
    append(s.body, f);
    f.parts.push_back(static_cast<int>(s.parts.size()));
    for (const dem::ConvexPart& part : s.parts) {
      append(part.core, f);
      f.part_radius.push_back(part.radius), f.crown.push_back(part.crown);
      f.mean_square.push_back(part.mean_square);
    }
    f.inertia.push_back(s.inertia), f.origin.push_back(s.origin), f.turn.push_back(s.turn);
    f.volume.push_back(s.volume), f.radius.push_back(s.radius);
    f.sieve_size.push_back(s.sieve_size);
  }
  return f;
}

dem::ShapeTable unflatten(const FlatShapes& f) {
  dem::ShapeTable table;
  PolyhedronReader polyhedra{f};
  std::size_t part = 0;
  for (std::size_t k = 0; k < f.parts.size(); ++k) {
    dem::GrainShape s;
    s.body = polyhedra.next();
    for (int i = 0; i < f.parts[k]; ++i, ++part)
      s.parts.push_back(
          {polyhedra.next(), f.part_radius[part], f.crown[part], f.mean_square[part]});
    s.inertia = f.inertia[k], s.origin = f.origin[k], s.turn = f.turn[k];
    s.volume = f.volume[k], s.radius = f.radius[k], s.sieve_size = f.sieve_size[k];
    table.add(s);
  }
  return table;
}

template <class A>
void visit(A& archive, EnergyFlows& f, EnergyStores& s) {
  std::vector<double> v{f.work,    f.prescribed, f.friction,  f.local_damping,  s.kinetic,
                        s.gravity, s.contact,    s.structure, f.contact_damping};
  archive("ledger", v);
  if (v.size() != 9) throw InputError("checkpoint: 'ledger' has another length");
  f.work = v[0], f.prescribed = v[1], f.friction = v[2], f.local_damping = v[3];
  s.kinetic = v[4], s.gravity = v[5], s.contact = v[6], s.structure = v[7];
  f.contact_damping = v[8];
}

template <class A>
void visit(A& archive, const std::string& at, Surface& s) {
  archive(at + "node", s.patch.node), archive(at + "velocity", s.patch.velocity);
  archive(at + "force", s.patch.force), archive(at + "last_force", s.last_force);
  archive(at + "given", s.given), archive(at + "owed", s.owed);
  archive(at + "owed_before", s.owed_before);
  archive(at + "work_predicted", s.work_predicted);
  archive(at + "node_travel", s.contacts.node_travel);
  archive(at + "searched_at", s.contacts.searched_at);
  std::vector<double> e{s.start.kinetic,
                        s.start.strain,
                        s.start.gravity,
                        s.start.work_loads,
                        s.start.work_surface,
                        s.start.dissipated_damping,
                        s.start.numerical,
                        s.start.at_start,
                        s.start.dissipated_material,
                        s.start.dissipated_boundary};
  archive(at + "start", e);
  if (e.size() != 10) throw InputError("checkpoint: '" + at + "start' has another length");
  s.start = {e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8], e[9]};
  dem::for_each_array(s.contacts,
                      [&](const char* name, auto& v) { archive(at + "contacts/" + name, v); });
}

template <class A>
void visit_all(A& archive, World& w) {
  archive("time", w.time);
  std::uint64_t step = w.step;
  archive("step", step);
  w.step = static_cast<long>(step);
  visit(archive, w.bodies);
  int resists = w.pairs.resists;
  archive("pairs/resists", resists);
  w.pairs.resists = resists;
  std::vector<double> damping{w.adaptive_damping.alpha, w.adaptive_damping.kinetic};
  archive("adaptive_damping", damping);
  if (damping.size() != 2) throw InputError("checkpoint: 'adaptive_damping' has another length");
  w.adaptive_damping = {damping[0], damping[1]};
  dem::for_each_array(w.pairs,
                      [&](const char* name, auto& v) { archive(std::string("pairs/") + name, v); });
  dem::Candidates::State c = w.candidates.state();
  std::uint64_t rebuilds = c.rebuilds;
  archive("candidates/skin", c.skin), archive("candidates/rebuilds", rebuilds);
  archive("candidates/travel", c.travel), archive("candidates/travel_search", c.travel_search);
  c.rebuilds = static_cast<long>(rebuilds);
  w.candidates.restore(c);
  visit(archive, w.flows, w.start);
}

std::string at(std::size_t k) { return "surface_" + std::to_string(k) + "/"; }

}  // namespace

void write_world(ArchiveWriter& archive, World& w) {
  FlatShapes shapes = flatten(w.shapes);
  visit(archive, shapes);
  visit_all(archive, w);
  int surfaces = static_cast<int>(w.surfaces.size());
  archive("surfaces", surfaces);
  for (std::size_t k = 0; k < w.surfaces.size(); ++k) {
    visit(archive, at(k), w.surfaces[k]);
    std::vector<double> state;
    w.surfaces[k].structure->save(state);
    archive(at(k) + "structure", state);
  }
}

void read_world(ArchiveReader& archive, World& w) {
  FlatShapes shapes;
  visit(archive, shapes);
  w.shapes = unflatten(shapes);
  visit_all(archive, w);
  w.pairs.index_bodies(w.bodies.size());
}

void read_surfaces(ArchiveReader& archive, World& w) {
  int surfaces = 0;
  archive("surfaces", surfaces);
  if (surfaces != static_cast<int>(w.surfaces.size()))
    throw InputError("checkpoint: it holds " + std::to_string(surfaces) +
                     " deforming surfaces, the scene " + std::to_string(w.surfaces.size()));
  for (std::size_t k = 0; k < w.surfaces.size(); ++k) {
    Surface& s = w.surfaces[k];
    const std::size_t nodes = s.patch.node.size(), carried = s.patch.force.size();
    visit(archive, at(k), s);
    if (s.patch.node.size() != nodes || s.patch.velocity.size() != nodes ||
        s.patch.force.size() != carried || s.last_force.size() != carried ||
        s.given.size() != carried || s.owed.size() != carried || s.owed_before.size() != carried)
      throw InputError("checkpoint: surface '" + s.patch.name + "' has another mesh (" +
                       std::to_string(s.patch.node.size()) + " nodes, the scene's " +
                       std::to_string(nodes) + ")");
    s.contacts.nodal.assign(s.contacts.size(), {});
    dem::find_round(w.bodies, w.shapes, s.contacts);
    std::vector<double> state;
    archive(at(k) + "structure", state);
    s.structure->load(state);
  }
}

}  // namespace trackbed::coupling
