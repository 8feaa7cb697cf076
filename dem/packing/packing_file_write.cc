#include <map>
#include <sstream>

#include "base/error.h"
#include "dem/grain/off_io.h"
#include "dem/packing/grain_pieces.h"
#include "dem/packing/packing_file.h"

namespace trackbed::dem {
namespace {

Vec3 corner(const PackedGrains& g, int i, const Vec3& p) { return g.centre[i] + g.turn[i] * p; }

std::ostringstream all_digits() {
  std::ostringstream out;
  out.precision(17);
  return out;
}

void write_point(std::ostringstream& out, const Vec3& x) {
  out << x.x() << ' ' << x.y() << ' ' << x.z() << '\n';
}

// One number a cell, that of its grain.
template <class Value>
void cell_data(std::ostringstream& out, const char* type, const char* name,
               const std::vector<int>& grain_of, Value&& v) {
  out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" format=\"ascii\">\n";
  for (const int i : grain_of) out << v(i) << '\n';
  out << "</DataArray>\n";
}

void append_bytes(const std::vector<Vec3>& v, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof v[0]);
}

}  // namespace

std::string packing_off_text(const PackedGrains& g) {
  std::vector<Polyhedron> outlines;
  std::size_t vertices = 0, faces = 0;
  for (const GrainShape& s : g.shape) {
    if (s.parts.size() > 1)
      throw InputError(
          "OFF holds no grains of several parts, as clumps are; CSV and VTU hold them");
    outlines.push_back(outline_pieces(s)[0]);
    vertices += outlines.back().vertices.size(), faces += outlines.back().faces.size();
  }
  std::ostringstream out = all_digits();
  out << "OFF\n" << vertices << ' ' << faces << " 0\n";
  for (int i = 0; i < g.size(); ++i)
    for (const Vec3& p : outlines[i].vertices) write_point(out, corner(g, i, p));
  std::size_t base = 0;
  for (const Polyhedron& body : outlines) {
    for (const auto& face : body.faces) {
      out << face.size();
      for (const int v : face) out << ' ' << base + v;
      out << '\n';
    }
    base += body.vertices.size();
  }
  return out.str();
}

DistinctShapes distinct_shapes(const PackedGrains& g) {
  DistinctShapes d;
  std::map<std::string, int> known;  // by the bytes of the vertices and radii
  for (int i = 0; i < g.size(); ++i) {
    std::string bytes;
    append_bytes(g.shape[i].body.vertices, bytes);
    for (const ConvexPart& part : g.shape[i].parts) {
      append_bytes(part.core.vertices, bytes);
      bytes.append(reinterpret_cast<const char*>(&part.radius), sizeof part.radius);
    }
    const auto [at, fresh] = known.emplace(bytes, static_cast<int>(d.first_of.size()));
    if (fresh) d.first_of.push_back(i);
    d.shape_of.push_back(at->second);
  }
  return d;
}

ShapeFile shape_file(const GrainShape& s) {
  std::ostringstream out = all_digits();
  switch (kind_of(s)) {
    case GrainKind::pieces: {
      PackedGrains pieces;  // in the grain's own frame, one solid each
      for (const ConvexPart& part : s.parts) {
        if (part.radius > 0)
          throw InputError("a grain of several dilated parts cannot be written to a CSV packing");
        GrainShape piece;
        piece.body = part.core;
        pieces.add(piece, Vec3::Zero(), Quat::Identity());
      }
      return {".off", packing_off_text(pieces)};
    }
    case GrainKind::spheres:
      out << "x,y,z,r\n";
      for (const Sphere& b : spheres_of(s))
        out << b.centre.x() << ',' << b.centre.y() << ',' << b.centre.z() << ',' << b.radius
            << '\n';
      return {".csv", out.str()};
    default:
      return {".off", off_text(s.parts.empty() ? s.body : s.parts[0].core)};
  }
}

std::string packing_csv_text(const PackedGrains& g, const std::vector<int>& shape_of) {
  std::ostringstream out = all_digits();
  out << "grain,shape,x_m,y_m,z_m,qw,qx,qy,qz,sieve_m,volume_m3,kind,radius_m\n";
  for (int i = 0; i < g.size(); ++i) {
    const Vec3& x = g.centre[i];
    const Quat& q = g.turn[i];
    const GrainKind kind = kind_of(g.shape[i]);
    out << i << ',' << shape_of[i] << ',' << x.x() << ',' << x.y() << ',' << x.z() << ',' << q.w()
        << ',' << q.x() << ',' << q.y() << ',' << q.z() << ',' << g.shape[i].sieve_size << ','
        << g.shape[i].volume << ',' << name_of(kind) << ','
        << (kind == GrainKind::dilated ? g.shape[i].parts[0].radius : 0.0) << '\n';
  }
  return out.str();
}

std::string packing_vtu_text(const PackedGrains& g) {
  std::ostringstream points = all_digits(), connectivity, offsets, faces, face_offsets;
  std::size_t base = 0, face_end = 0;
  std::vector<int> grain_of;  // of each cell
  std::vector<Polyhedron> cells;
  for (int i = 0; i < g.size(); ++i)
    for (Polyhedron& piece : outline_pieces(g.shape[i]))
      cells.push_back(std::move(piece)), grain_of.push_back(i);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Polyhedron& body = cells[c];
    for (const Vec3& p : body.vertices) write_point(points, corner(g, grain_of[c], p));
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
      << base << "\" NumberOfCells=\"" << cells.size()
      << "\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" "
         "format=\"ascii\">\n"
      << points.str() << "</DataArray>\n</Points>\n<Cells>\n";
  ints("connectivity", connectivity.str());
  ints("offsets", offsets.str());
  cell_data(out, "UInt8", "types", grain_of, [](int) { return 42; });  // VTK_POLYHEDRON
  ints("faces", faces.str());
  ints("faceoffsets", face_offsets.str());
  out << "</Cells>\n<CellData>\n";
  cell_data(out, "Int64", "grain", grain_of, [](int i) { return i; });
  cell_data(out, "Float64", "sieve_m", grain_of, [&](int i) { return g.shape[i].sieve_size; });
  cell_data(out, "Float64", "volume_m3", grain_of, [&](int i) { return g.shape[i].volume; });
  out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  return out.str();
}

}  // namespace trackbed::dem
