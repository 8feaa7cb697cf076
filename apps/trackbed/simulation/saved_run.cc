#include "apps/trackbed/simulation/saved_run.h"

#include "apps/trackbed/simulation/actors.h"
#include "base/error.h"
#include "coupling/archive.h"
#include "coupling/checkpoint.h"

namespace trackbed::apps {
namespace {

constexpr int kFormat = 9;  // raised when the arrays change

template <class A>
void visit(A& a, const std::string& name, bool& flag) {
  int value = flag;
  a(name, value);
  flag = value != 0;
}

template <class A>
void visit(A& a, Actors& t) {
  a("actors/walls", t.walls);
  visit(a, "actors/floor", t.floor);
  visit(a, "actors/plate", t.plate);
  visit(a, "actors/sample", t.sample);
  visit(a, "actors/rigid_sleeper", t.rigid_sleeper);
  a("actors/sleeper_surface", t.sleeper_surface);
  a("actors/subgrade_surface", t.subgrade_surface);
  a("actors/sleeper_base", t.sleeper_base);
  a("actors/sleeper_start", t.sleeper_start);
}

template <class A>
void visit(A& a, StageState& s) {
  a("stage/index", s.index), a("stage/steps", s.steps), a("stage/cycles", s.cycles);
  a("stage/halvings", s.halvings), a("stage/steps_per_cycle", s.steps_per_cycle);
  a("stage/friction", s.friction), a("stage/stop_at", s.stop_at);
  a("stage/stop_friction", s.stop_friction);
  a("stage/dt", s.dt), a("stage/start", s.start), a("stage/load", s.load), a("stage/u0", s.u0);
  a("stage/pad", s.pad), a("stage/pad_work", s.pad_work), a("stage/pad_loss", s.pad_loss);
  a("stage/u_min", s.u_min), a("stage/load_min", s.load_min);
  a("stage/u_max", s.u_max), a("stage/load_max", s.load_max);
  a("stage/push_start", s.push_start), a("stage/push", s.push);
  a("stage/push_force", s.push_force), a("stage/push_stiffness", s.push_stiffness);
  a("stage/largest_overlap", s.largest_overlap);
  a("stage/largest_step_share", s.largest_step_share);
  a("stage/work_in", s.work_in), a("stage/last_work", s.last_work);
  a("stage/worst_closure", s.worst_closure), a("stage/exchange_gain", s.exchange_gain);
  a("stage/structure_gain", s.structure_gain);
  a("stage/unrest", s.unrest), a("stage/grain_force", s.grain_force);
  a("stage/pressure", s.pressure), a("stage/pressure_samples", s.pressure_samples);
}

template <class A>
void visit(A& a, std::vector<PathPoint>& path) {
  std::vector<int> from;
  std::vector<double> values;  // seven a point
  for (const PathPoint& p : path) {
    from.push_back(p.point.from);
    values.insert(values.end(), {p.point.friction, p.point.porosity, p.height, p.coordination,
                                 p.unbalanced, p.time, p.point.stop_at});
  }
  a("path/from", from), a("path/values", values);
  if (values.size() != 7 * from.size()) throw InputError("checkpoint: 'path' has another length");
  path.clear();
  for (std::size_t k = 0; k < from.size(); ++k) {
    const double* v = &values[7 * k];
    path.push_back({{from[k], v[0], v[1], v[6]}, v[2], v[3], v[4], v[5]});
  }
}

template <class A>
void visit(A& a, GrainTestState& t) {
  a("test/specimen", t.specimen), a("test/placed", t.placed);
  std::vector<dem::Vec3> space{t.low, t.high, t.lengths};
  a("test/space", space);
  if (space.size() != 3) throw InputError("checkpoint: 'test/space' has another length");
  t.low = space[0], t.high = space[1], t.lengths = space[2];
  a("test/plane", t.plane), a("test/solid", t.solid), a("test/size", t.size);
  a("test/drift", t.drift), a("test/sum", t.sum), a("test/rows", t.rows);
  a("test/steps", t.steps), a("test/rows_done", t.rows_done);
}

template <class A>
void visit(A& a, RunRecords& r) {
  a("records/rows", r.rows);
  a("records/snapshots", r.snapshots.count), a("records/meshes", r.snapshots.meshes);
  a("records/mesh_grains", r.snapshots.mesh_grains), a("records/times", r.snapshots.times);
  a("records/mesh_of", r.snapshots.mesh_of), a("records/points_of", r.snapshots.points_of);
  a("records/triangles_of", r.snapshots.triangles_of);
}

template <class A>
void visit(A& a, coupling::StepTimes& t) {
  std::vector<double> v{t.motion,
                        t.candidates,
                        t.grain_contacts,
                        t.surface_contacts,
                        t.structures,
                        static_cast<double>(t.steps),
                        static_cast<double>(t.iterations)};
  a("times", v);
  if (v.size() == 7)
    t = {v[0], v[1], v[2], v[3], v[4], static_cast<long>(v[5]), static_cast<long>(v[6])};
}

}  // namespace

void save_run(const std::string& file, Run& run, const RunRecords& records) {
  coupling::ArchiveWriter a(file);
  int format = kFormat;
  a("format", format);
  visit(a, run.actors);
  visit(a, run.stage);
  visit(a, run.path);
  if (run.scene.test.on()) visit(a, run.test);
  RunRecords copy = records;
  visit(a, copy);
  visit(a, run.world.times);
  double wall = wall_time(run);
  a("wall", wall);
  coupling::write_world(a, run.world);
  a.commit();
}

RunRecords load_run(const std::string& file, Run& run) {
  coupling::ArchiveReader a(file);
  int format = 0;
  a("format", format);
  if (format != kFormat)
    throw InputError(file + ": format " + std::to_string(format) + ", this program reads " +
                     std::to_string(kFormat));
  visit(a, run.actors);
  visit(a, run.stage);
  visit(a, run.path);
  if (run.scene.test.on()) visit(a, run.test);
  RunRecords records;
  visit(a, records);
  visit(a, run.world.times);
  a("wall", run.wall_before);
  run.layout = run.actors.sample ? sample_layout(run.scene) : make_layout(run.scene);
  coupling::read_world(a, run.world);
  if (run.actors.sleeper_surface >= 0 || run.actors.subgrade_surface >= 0) {
    build_structures(run);
    coupling::read_surfaces(a, run.world);
  }
  return records;
}

void restore_bed(const std::string& file, Run& run) {
  const StageState stage = run.stage;
  const std::vector<PathPoint> path = run.path;
  const GrainTestState test = run.test;
  const double time = run.world.time;
  const long step = run.world.step;
  const coupling::StepTimes times = run.world.times;
  const double wall = run.wall_before;
  load_run(file, run);
  run.wall_before = wall;
  run.stage = stage;
  run.path = path;
  run.test = test;
  run.world.time = time, run.world.step = step, run.world.times = times;
}

}  // namespace trackbed::apps
