#include "apps/trackbed/simulation/snapshots.h"

#include <hdf5.h>

#include <cstdio>
#include <sstream>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/files.h"
#include "base/error.h"
#include "dem/grain/parts.h"
#include "fem/elastic_body.h"

namespace trackbed::apps {
namespace {

using dem::Vec3;

std::string numbered(const char* stem, int k) {
  char text[32];
  std::snprintf(text, sizeof text, "%s%04d", stem, k);
  return text;
}

// Thin layer over one HDF5 file; any failure throws.
class File {
 public:
  File(const std::string& path, bool fresh) : path_(path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    // One who looks at the file meanwhile must not stop the run: no locks.
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(access, false, true);
    id_ = fresh ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access)
                : H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
    H5Pclose(access);
    if (id_ < 0 && !fresh)
      throw RunError(path + ": cannot be gone on with: missing, damaged or not to be written to");
    check(id_ >= 0);
  }
  ~File() {
    if (id_ >= 0) H5Fclose(id_);
  }
  void close() {
    check(H5Fclose(id_) >= 0);
    id_ = -1;
  }

  // A group made anew: a resumed run replaces what came after its checkpoint.
  void group(const std::string& name) {
    if (H5Lexists(id_, name.c_str(), H5P_DEFAULT) > 0) H5Ldelete(id_, name.c_str(), H5P_DEFAULT);
    const hid_t g = H5Gcreate2(id_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    check(g >= 0);
    H5Gclose(g);
  }

  template <class T>
  void array(const std::string& name, const std::vector<T>& v, hsize_t columns, hid_t memory,
             hid_t disk) {
    hsize_t size[2] = {v.size() / columns, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, size, nullptr);
    const hid_t set =
        H5Dcreate2(id_, name.c_str(), disk, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = set >= 0 && (v.empty() || H5Dwrite(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                                         v.data()) >= 0);
    if (set >= 0) H5Dclose(set);
    H5Sclose(space);
    check(good);
  }
  void floats(const std::string& name, const std::vector<Vec3>& v) {
    std::vector<double> flat;
    for (const Vec3& p : v) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
    array(name, flat, 3, H5T_NATIVE_DOUBLE, H5T_IEEE_F32LE);
  }
  void doubles(const std::string& name, const std::vector<Vec3>& v) {
    std::vector<double> flat;
    for (const Vec3& p : v) flat.insert(flat.end(), {p.x(), p.y(), p.z()});
    array(name, flat, 3, H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE);
  }
  void floats(const std::string& name, const std::vector<double>& v) {
    array(name, v, 1, H5T_NATIVE_DOUBLE, H5T_IEEE_F32LE);
  }
  void ints(const std::string& name, const std::vector<int>& v, hsize_t columns) {
    array(name, v, columns, H5T_NATIVE_INT, H5T_STD_I32LE);
  }

  void attribute(const std::string& at, const char* name, double v) {
    write(at, name, H5T_NATIVE_DOUBLE, &v);
  }
  void attribute(const std::string& at, const char* name, int v) {
    write(at, name, H5T_NATIVE_INT, &v);
  }
  void attribute(const std::string& at, const char* name, const std::string& v) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, v.size() + 1);
    write(at, name, type, v.c_str());
    H5Tclose(type);
  }

 private:
  void write(const std::string& at, const char* name, hid_t type, const void* data) {
    const hid_t object = H5Oopen(id_, at.c_str(), H5P_DEFAULT);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t a = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = a >= 0 && H5Awrite(a, type, data) >= 0;
    if (a >= 0) H5Aclose(a);
    H5Sclose(space);
    H5Oclose(object);
    check(good);
  }
  void check(bool good) const {
    if (!good) throw RunError(path_ + ": cannot be written (disk full?)");
  }
  std::string path_;
  hid_t id_ = -1;
};

void append_body(const coupling::World& w, int body, std::vector<Vec3>& points,
                 std::vector<int>& triangles) {
  const int base = static_cast<int>(points.size());
  const dem::Polyhedron p = dem::drawing(w.shapes.shape(w.bodies.shape[body]));
  for (const Vec3& v : p.vertices) points.push_back(w.bodies.x[body] + w.bodies.R[body] * v);
  for (const auto& face : p.faces)
    for (std::size_t k = 2; k < face.size(); ++k)
      triangles.insert(triangles.end(), {base + face[0], base + face[k - 1], base + face[k]});
}

struct Contacts {
  std::vector<Vec3> point, force;
  std::vector<int> grains, coordination;
  std::vector<double> grain_force;
};

Contacts gather_contacts(const coupling::World& w) {
  const dem::Bodies& b = w.bodies;
  Contacts c;
  c.coordination.assign(b.grains, 0);
  c.grain_force.assign(b.grains, 0);
  const auto add = [&](const Vec3& point, const Vec3& force, int i, int j) {
    c.point.push_back(point), c.force.push_back(force);
    c.grains.insert(c.grains.end(), {i, j});
    for (const int k : {i, j})
      if (k >= 0 && k < b.grains) ++c.coordination[k], c.grain_force[k] += force.norm();
  };
  for (int p = 0; p < w.pairs.size(); ++p)
    if (w.pairs.touching[p])
      add(b.x[w.pairs.a[p]] + w.pairs.arm_a[p], w.pairs.force[p], w.pairs.a[p], w.pairs.b[p]);
  for (std::size_t s = 0; s < w.surfaces.size(); ++s) {
    const dem::PatchContacts& k = w.surfaces[s].contacts;
    for (int i = 0; i < k.size(); ++i)
      if (k.touching[i]) add(k.point[i], k.force[i], k.grain[i], -1 - static_cast<int>(s));
  }
  return c;
}

void write_xdmf(const std::string& folder, const SnapshotLog& log) {
  std::ostringstream x;
  x << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
       "<Grid Name=\"grains\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (int k = 0; k < log.count; ++k) {
    const std::string at = "snapshots.h5:/" + numbered("snapshot_", k) + "/";
    const std::string mesh = "snapshots.h5:/mesh_" + std::to_string(log.mesh_of[k]) + "/";
    const int points = log.points_of[k], triangles = log.triangles_of[k];
    x << "<Grid Name=\"" << numbered("snapshot_", k) << "\"><Time Value=\""
      << shortest(log.times[k]) << "\"/>\n<Topology TopologyType=\"Triangle\" NumberOfElements=\""
      << triangles << "\"><DataItem Dimensions=\"" << triangles
      << " 3\" NumberType=\"Int\" Format=\"HDF\">" << mesh << "triangles</DataItem></Topology>\n"
      << "<Geometry GeometryType=\"XYZ\"><DataItem Dimensions=\"" << points
      << " 3\" NumberType=\"Float\" Precision=\"4\" Format=\"HDF\">" << at
      << "points</DataItem></Geometry>\n"
      << "<Attribute Name=\"contact force on the grain, N\" Center=\"Cell\"><DataItem Dimensions=\""
      << triangles << "\" NumberType=\"Float\" Precision=\"4\" Format=\"HDF\">" << at
      << "triangle_force</DataItem></Attribute>\n"
      << "<Attribute Name=\"grain\" Center=\"Cell\"><DataItem Dimensions=\"" << triangles
      << "\" NumberType=\"Int\" Format=\"HDF\">" << mesh
      << "triangle_grain</DataItem></Attribute>\n</Grid>\n";
  }
  x << "</Grid></Domain></Xdmf>\n";
  write_aside_then_rename(folder + "/snapshots.xdmf", x.str());
}

void write_structures(const Run& run, const std::string& folder, const SnapshotLog& log) {
  for (const coupling::Surface& s : run.world.surfaces) {
    if (!s.structure->has_fields()) continue;
    const std::string stem = "structure_" + s.patch.name;
    s.structure->write_vtu(folder + "/" + numbered((stem + "_").c_str(), log.count) + ".vtu");
    std::vector<fem::PvdRecord> records;
    for (int k = 0; k <= log.count; ++k) {
      const std::string vtu = numbered((stem + "_").c_str(), k) + ".vtu";
      if (std::FILE* f = std::fopen((folder + "/" + vtu).c_str(), "r")) {
        std::fclose(f);
        records.push_back({k < log.count ? log.times[k] : run.world.time, vtu});
      }
    }
    fem::write_pvd(folder + "/" + stem + ".pvd", records);
  }
}

}  // namespace

void write_snapshot(const Run& run, const Stage& stage, const std::string& folder, bool fields,
                    SnapshotLog& log) {
  const coupling::World& w = run.world;
  std::vector<Vec3> points, rigid_points;
  std::vector<int> triangles, triangle_grain, rigid_triangles;
  for (int i = 0; i < w.bodies.grains; ++i) {
    append_body(w, i, points, triangles);
    triangle_grain.resize(triangles.size() / 3, i);
  }
  if (run.actors.plate || run.actors.rigid_sleeper)
    append_body(w, w.bodies.grains + run.actors.walls, rigid_points, rigid_triangles);
  const Contacts contacts = gather_contacts(w);
  std::vector<double> triangle_force;
  for (const int g : triangle_grain) triangle_force.push_back(contacts.grain_force[g]);

  File file(folder + "/snapshots.h5", log.count == 0);
  if (log.count == 0) file.attribute("/", "title", run.scene.title);
  if (log.mesh_grains != w.bodies.grains) {
    const std::string mesh = "mesh_" + std::to_string(log.meshes++);
    file.group(mesh);
    file.ints(mesh + "/triangles", triangles, 3);
    file.ints(mesh + "/triangle_grain", triangle_grain, 1);
    log.mesh_grains = w.bodies.grains;
  }
  const std::string at = numbered("snapshot_", log.count);
  file.group(at);
  file.attribute(at, "time_s", w.time);
  file.attribute(at, "stage", stage.name);
  file.attribute(at, "mesh", log.meshes - 1);
  file.attribute(at, "load_N", run.stage.load);
  file.floats(at + "/points", points);
  file.floats(at + "/triangle_force", triangle_force);
  const auto first = [&](const std::vector<Vec3>& v) {
    return std::vector<Vec3>(v.begin(), v.begin() + w.bodies.grains);
  };
  file.doubles(at + "/grain_position", first(w.bodies.x));
  file.doubles(at + "/grain_velocity", first(w.bodies.v));
  file.ints(at + "/grain_coordination", contacts.coordination, 1);
  file.floats(at + "/grain_force", contacts.grain_force);
  file.floats(at + "/contact_point", contacts.point);
  file.floats(at + "/contact_force", contacts.force);
  file.ints(at + "/contact_grains", contacts.grains, 2);
  file.floats(at + "/rigid_points", rigid_points);
  file.ints(at + "/rigid_triangles", rigid_triangles, 3);
  file.close();
  if (fields) write_structures(run, folder, log);

  log.times.push_back(w.time);
  log.mesh_of.push_back(log.meshes - 1);
  log.points_of.push_back(static_cast<int>(points.size()));
  log.triangles_of.push_back(static_cast<int>(triangles.size() / 3));
  ++log.count;
  write_xdmf(folder, log);
}

}  // namespace trackbed::apps
