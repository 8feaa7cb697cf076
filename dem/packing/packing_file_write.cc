#include <map>
#include <sstream>

#include "dem/packing/packing_file.h"

namespace trackbed::dem {
namespace {

Vec3 corner(const PackedGrains& g, int i, const Vec3& p) { return g.centre[i] + g.turn[i] * p; }

std::ostringstream all_digits() {
  std::ostringstream out;
  out.precision(17);
  return out;
}

// One number a grain.
template <class Value>
void cell_data(std::ostringstream& out, const char* type, const char* name, int grains, Value&& v) {
  out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
  for (int i = 0; i < grains; ++i) out << v(i) << '\n';
  out << "</DataArray>\n";
}

}  // namespace

std::string packing_off_text(const PackedGrains& g) {
  std::size_t vertices = 0, faces = 0;
  for (const GrainShape& s : g.shape)
    vertices += s.body.vertices.size(), faces += s.body.faces.size();
  std::ostringstream out = all_digits();
  out << "OFF\n" << vertices << ' ' << faces << " 0\n";
  for (int i = 0; i < g.size(); ++i)
    for (const Vec3& p : g.shape[i].body.vertices) {
      const Vec3 x = corner(g, i, p);
      out << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    }
  std::size_t base = 0;
  for (const GrainShape& s : g.shape) {
    for (const auto& face : s.body.faces) {
      out << face.size();
      for (const int v : face) out << ' ' << base + v;
      out << '\n';
    }
    base += s.body.vertices.size();
  }
  return out.str();
}

DistinctShapes distinct_shapes(const PackedGrains& g) {
  DistinctShapes d;
  std::map<std::string, int> known;  // by the bytes of the vertices
  for (int i = 0; i < g.size(); ++i) {
    const auto& v = g.shape[i].body.vertices;
    const std::string bytes(reinterpret_cast<const char*>(v.data()), v.size() * sizeof v[0]);
    const auto [at, fresh] = known.emplace(bytes, static_cast<int>(d.first_of.size()));
    if (fresh) d.first_of.push_back(i);
    d.shape_of.push_back(at->second);
  }
  return d;
}

std::string packing_csv_text(const PackedGrains& g, const std::vector<int>& shape_of) {
  std::ostringstream out = all_digits();
  out << "grain,shape,x_m,y_m,z_m,qw,qx,qy,qz,sieve_m,volume_m3\n";
  for (int i = 0; i < g.size(); ++i) {
    const Vec3& x = g.centre[i];
    const Quat& q = g.turn[i];
    out << i << ',' << shape_of[i] << ',' << x.x() << ',' << x.y() << ',' << x.z() << ',' << q.w()
        << ',' << q.x() << ',' << q.y() << ',' << q.z() << ',' << g.shape[i].sieve_size << ','
        << g.shape[i].volume << '\n';
  }
  return out.str();
}

std::string packing_vtu_text(const PackedGrains& g) {
  std::ostringstream points = all_digits(), connectivity, offsets, faces, face_offsets;
  std::size_t base = 0, face_end = 0;
  for (int i = 0; i < g.size(); ++i) {
    const Polyhedron& body = g.shape[i].body;
    for (const Vec3& p : body.vertices) {
      const Vec3 x = corner(g, i, p);
      points << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
    }
    for (std::size_t k = 0; k < body.vertices.size(); ++k) connectivity << base + k << ' ';
    connectivity << '\n';
    faces << body.faces.size();
    ++face_end;
    for (const auto& face : body.faces) {
      faces << ' ' << face.size();
      for (const int v : face) faces << ' ' << base + v;
      face_end += 1 + face.size();
    }
    faces << '\n';
    base += body.vertices.size();
    offsets << base << '\n';
    face_offsets << face_end << '\n';
  }
  std::ostringstream out = all_digits();
  const auto ints = [&](const char* name, const std::string& text) {
    out << "<DataArray type=\"Int64\" Name=\"" << name << "\" format=\"ascii\">\n"
        << text << "</DataArray>\n";
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\""
      << base << "\" NumberOfCells=\"" << g.size()
      << "\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
         "format=\"ascii\">\n"
      << points.str() << "</DataArray>\n</Points>\n<Cells>\n";
  ints("connectivity", connectivity.str());
  ints("offsets", offsets.str());
  cell_data(out, "UInt8", "types", g.size(), [](int) { return 42; });  // VTK_POLYHEDRON
  ints("faces", faces.str());
  ints("faceoffsets", face_offsets.str());
  out << "</Cells>\n<CellData>\n";
  cell_data(out, "Int64", "grain", g.size(), [](int i) { return i; });
  cell_data(out, "Float64", "sieve_m", g.size(), [&](int i) { return g.shape[i].sieve_size; });
  cell_data(out, "Float64", "volume_m3", g.size(), [&](int i) { return g.shape[i].volume; });
  out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return out.str();
}

}  // namespace trackbed::dem
