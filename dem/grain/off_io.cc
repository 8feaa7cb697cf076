#include "dem/grain/off_io.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "dem/grain/mesh_parse.h"

namespace trackbed::dem {
namespace {

double extent(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

// Vertices within `tolerance` become one; faces that collapse vanish, unused vertices too.
RawMesh welded(const RawMesh& mesh, double tolerance) {
  const int n = static_cast<int>(mesh.vertices.size());
  std::vector<int> order(n), target(n, -1);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return mesh.vertices[a].x() < mesh.vertices[b].x(); });
  RawMesh result;
  result.single_precision = mesh.single_precision;
  std::vector<int> kept;  // along x
  for (int v : order) {
    for (size_t k = kept.size(); k-- > 0 && target[v] < 0;) {
      const Vec3 gap = mesh.vertices[v] - mesh.vertices[kept[k]];
      if (gap.x() > tolerance) break;
      if (gap.norm() <= tolerance) target[v] = target[kept[k]];
    }
    if (target[v] >= 0) continue;
    target[v] = static_cast<int>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
    kept.push_back(v);
  }
  for (const auto& face : mesh.faces) {
    std::vector<int> loop;
    for (int v : face)
      if (loop.empty() || loop.back() != target[v]) loop.push_back(target[v]);
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if (loop.size() >= 3) result.faces.push_back(loop);
  }
  return result;
}

// Closed, consistently wound, in one piece.
void check_surface(const std::string& path, const RawMesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& face : mesh.faces)
    for (size_t k = 0; k < face.size(); ++k) ++directed[{face[k], face[(k + 1) % face.size()]}];
  std::vector<int> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& [edge, uses] : directed) {
    const auto back = directed.find({edge.second, edge.first});
    const int opposite = back == directed.end() ? 0 : back->second;
    if (uses + opposite == 1)
      throw InputError(path + ": the surface is open (an edge has one face)");
    if (uses + opposite > 2)
      throw InputError(path + ": the surface is not manifold (an edge has more than two faces)");
    if (uses == 2) throw InputError(path + ": neighbouring faces are wound against each other");
    root[find(edge.first)] = find(edge.second);
  }
  for (const auto& face : mesh.faces)
    if (find(face[0]) != find(mesh.faces[0][0]))
      throw InputError(path + ": the file holds more than one solid");
}

bool self_intersects(const RawMesh& mesh) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  std::vector<CGAL::Surface_mesh<Kernel::Point_3>::Vertex_index> vertex;
  for (const Vec3& p : mesh.vertices) vertex.push_back(surface.add_vertex({p.x(), p.y(), p.z()}));
  for (const auto& face : mesh.faces)
    for (size_t k = 1; k + 1 < face.size(); ++k)
      surface.add_face(vertex[face[0]], vertex[face[k]], vertex[face[k + 1]]);
  return CGAL::Polygon_mesh_processing::does_self_intersect(surface);
}

double signed_volume(const Polyhedron& body) {
  double six = 0;
  const Vec3& o = body.vertices[body.faces[0][0]];
  for (const auto& face : body.faces)
    for (size_t k = 1; k + 1 < face.size(); ++k)
      six += (body.vertices[face[0]] - o)
                 .dot((body.vertices[face[k]] - o).cross(body.vertices[face[k + 1]] - o));
  return six / 6;
}

std::string slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened");
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad() || text.str().empty()) throw InputError(path + ": is empty or cannot be read");
  return text.str();
}

RawMesh parse(const std::string& path) {
  std::string kind = path.substr(std::min(path.size(), path.find_last_of('.') + 1));
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (kind == "off") return parse_off(path, slurp(path));
  if (kind == "obj") return parse_obj(path, slurp(path));
  if (kind == "stl") return parse_stl(path, slurp(path));
  throw InputError(path + ": unknown kind of file; .off, .obj and .stl are read");
}

// The pieces that no face joins, each with its own vertices.
std::vector<RawMesh> pieces_of(const RawMesh& mesh) {
  std::vector<int> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const auto& face : mesh.faces)
    for (int v : face) root[find(v)] = find(face[0]);
  std::map<int, int> piece_of;  // root to piece
  std::vector<int> own(mesh.vertices.size(), -1);
  std::vector<RawMesh> pieces;
  for (const auto& face : mesh.faces) {
    const auto [at, first] = piece_of.emplace(find(face[0]), static_cast<int>(pieces.size()));
    if (first) pieces.emplace_back();
    RawMesh& piece = pieces[at->second];
    piece.single_precision = mesh.single_precision;
    piece.faces.push_back(face);
    for (int& v : piece.faces.back()) {
      if (own[v] < 0) {
        own[v] = static_cast<int>(piece.vertices.size());
        piece.vertices.push_back(mesh.vertices[v]);
      }
      v = own[v];
    }
  }
  return pieces;
}

// A closed solid of positive volume, in metres; `tolerance` relative to its extent.
RawMesh closed(const std::string& path, RawMesh mesh, double unit, double& tolerance) {
  if (!(unit > 0) || !std::isfinite(unit))
    throw InputError("solid: the unit of length must be positive");
  if (mesh.vertices.empty() || mesh.faces.empty()) throw InputError(path + ": holds no faces");
  tolerance = mesh.single_precision ? 3e-7 : 1e-9;
  for (Vec3& v : mesh.vertices) v *= unit;
  const double size = extent(mesh.vertices);
  mesh = welded(mesh, tolerance * size);
  if (mesh.faces.empty()) throw InputError(path + ": the solid has no volume");
  check_surface(path, mesh);
  const double volume = signed_volume({mesh.vertices, mesh.faces});
  if (std::abs(volume) <= 1e-12 * size * size * size)
    throw InputError(path + ": the solid has no volume");
  if (volume < 0) throw InputError(path + ": the solid is inside-out (its faces point inwards)");
  return mesh;
}

}  // namespace

Polyhedron read_solid(const std::string& path, const SolidOptions& options) {
  return check_solid(path, parse(path), options);
}

std::vector<Polyhedron> read_solids(const std::string& path, const SolidOptions& options) {
  const RawMesh mesh = parse(path);
  if (mesh.vertices.empty() || mesh.faces.empty()) throw InputError(path + ": holds no faces");
  // Solids that touch may have corners in one place: they are told apart by their indices, unless
  // the file gives each facet corners of its own.
  const double tolerance = mesh.single_precision ? 3e-7 : 1e-9;
  auto pieces = pieces_of(mesh);
  if (std::any_of(pieces.begin(), pieces.end(), [](const auto& p) { return p.faces.size() == 1; }))
    pieces = pieces_of(welded(mesh, tolerance * extent(mesh.vertices)));
  std::vector<Polyhedron> solids;
  for (size_t k = 0; k < pieces.size(); ++k)
    solids.push_back(check_solid(
        pieces.size() > 1 ? path + ": solid " + std::to_string(k + 1) : path, pieces[k], options));
  if (solids.empty()) throw InputError(path + ": the solid has no volume");
  return solids;
}

Polyhedron check_solid(const std::string& path, const RawMesh& raw, const SolidOptions& options) {
  double tolerance = 0;
  const RawMesh mesh = closed(path, raw, options.unit, tolerance);
  const double size = extent(mesh.vertices);
  const double volume = signed_volume({mesh.vertices, mesh.faces});
  std::vector<Vec3> corners;  // a vertex that no face uses is no part of the solid
  for (const auto& face : mesh.faces)
    for (int v : face) corners.push_back(mesh.vertices[v]);
  Polyhedron hull;
  try {
    hull = convex_hull(corners, tolerance);
  } catch (const InputError& e) {
    throw InputError(path + ": " + e.what());
  }
  // Every point of a closed surface in its hull's boundary: convex. A dent shows in the volume.
  const double missing = 1 - volume / mass_properties(hull).volume;
  if (std::abs(missing) <= 10 * tolerance * size * size * size / volume && missing < 1e-4)
    return hull;
  if (self_intersects(mesh)) throw InputError(path + ": the surface intersects itself");
  if (options.hull) return hull;
  char text[200];
  std::snprintf(
      text, sizeof text,
      ": the solid is not convex (its hull is %.3g %% larger); ask for the hull to use that",
      100 * (mass_properties(hull).volume / volume - 1));
  throw InputError(path + text);
}

TriangleSolid read_triangle_solid(const std::string& path, double unit) {
  double tolerance = 0;
  const RawMesh mesh = closed(path, parse(path), unit, tolerance);
  if (self_intersects(mesh)) throw InputError(path + ": the surface intersects itself");
  TriangleSolid solid{mesh.vertices, {}};
  for (const auto& face : mesh.faces)
    for (size_t k = 1; k + 1 < face.size(); ++k)
      solid.triangles.push_back({face[0], face[k], face[k + 1]});
  return solid;
}

void write_off(const std::string& path, const TriangleSolid& solid) {
  Polyhedron body{solid.vertices, {}};
  for (const auto& t : solid.triangles) body.faces.push_back({t[0], t[1], t[2]});
  write_off(path, body);
}

std::string off_text(const Polyhedron& body) {
  std::ostringstream text;
  text << "OFF\n" << body.vertices.size() << ' ' << body.faces.size() << " 0\n";
  text.precision(17);
  for (const Vec3& v : body.vertices) text << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& face : body.faces) {
    text << face.size();
    for (int v : face) text << ' ' << v;
    text << '\n';
  }
  return text.str();
}

void write_off(const std::string& path, const Polyhedron& body) {
  std::ofstream file(path);
  file << off_text(body);
  file.close();
  if (!file) throw InputError(path + ": cannot be written");
}

}  // namespace trackbed::dem
