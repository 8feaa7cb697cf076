#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "base/error.h"
#include "dem/grain/clump_io.h"
#include "dem/grain/off_io.h"
#include "dem/grain/parts.h"
#include "dem/packing/packing_file.h"

namespace trackbed::dem {
namespace {

std::string ending(const std::string& path) {
  const auto dot = path.find_last_of('.');
  return dot == std::string::npos ? "" : path.substr(dot + 1);
}

std::string read_all(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": cannot be opened");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// A shape in its file's frame as a grain whose frame stands at x, turned by q.
void add_posed(PackedGrains& g, GrainShape s, const Vec3& x, const Quat& q, double sieve) {
  s.sieve_size = sieve;
  g.add(s, x + q * s.origin, (q * s.turn).normalized());
}

PackedGrains read_off(const std::string& path) {
  PackedGrains g;
  for (const Polyhedron& body : read_solids(path))
    add_posed(g, make_grain_shape(body), Vec3::Zero(), Quat::Identity(), 0);
  return g;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  return cells;
}

struct Row {
  int shape;
  Vec3 x;
  Quat q;
  double sieve;
  std::string kind;
  double radius;  // of a dilated polyhedron
};

std::string shape_path(const std::string& csv, const Row& row) {
  return csv.substr(0, csv.size() - 4) + "_shapes/" + std::to_string(row.shape) +
         (row.kind == "spheres" ? ".csv" : ".off");
}

GrainShape read_shape(const std::string& path, const Row& row) {
  if (row.kind == "spheres") return as_grain(make_clump_shape(read_clump(path)));
  if (row.kind == "pieces") return union_shape(read_solids(path));
  const Polyhedron solid = read_solid(path);
  return row.kind == "dilated" ? as_grain(make_dilated_shape({solid, row.radius}))
                               : make_grain_shape(solid);
}

std::vector<Row> read_rows(const std::string& path) {
  std::istringstream text(read_all(path));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> header = split(line);
  static const char* names[] = {"shape", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz", "sieve_m"};
  int column[9];
  for (int k = 0; k < 9; ++k) {
    const auto at = std::find(header.begin(), header.end(), names[k]);
    if (at == header.end())
      throw InputError(path + ": a packing needs the column '" + names[k] + "'");
    column[k] = static_cast<int>(at - header.begin());
  }
  const auto find = [&](const char* name) { return std::find(header.begin(), header.end(), name); };
  const auto kind_at = find("kind") - header.begin(), radius_at = find("radius_m") - header.begin();
  std::vector<Row> rows;
  for (int number = 2; std::getline(text, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::string at = path + ": line " + std::to_string(number) + ": ";
    const std::vector<std::string> cells = split(line);
    const auto cell = [&](std::ptrdiff_t k) {
      return k < static_cast<std::ptrdiff_t>(cells.size()) ? cells[k] : std::string();
    };
    const auto number_in = [&](const char* name, std::ptrdiff_t k) {
      const std::string text = cell(k);
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      if (text.empty() || *end != '\0' || !std::isfinite(value))
        throw InputError(at + name + " = '" + text + "' is not a number");
      return value;
    };
    double v[9];
    for (int k = 0; k < 9; ++k) v[k] = number_in(names[k], column[k]);
    const Quat q(v[4], v[5], v[6], v[7]);
    if (std::abs(q.norm() - 1) > 1e-6) throw InputError(at + "the quaternion's length is not 1");
    if (v[0] < 0 || v[0] != std::floor(v[0]) || v[0] > 1e9)
      throw InputError(at + "shape is not a whole number");
    const bool told = kind_at < static_cast<std::ptrdiff_t>(header.size());
    const std::string kind = told ? cell(kind_at) : "polyhedron";
    if (kind != "polyhedron" && kind != "spheres" && kind != "dilated" && kind != "pieces")
      throw InputError(at + "kind = '" + kind +
                       "'; allowed are polyhedron, spheres, dilated, pieces");
    const double radius = kind == "dilated" ? number_in("radius_m", radius_at) : 0;
    if (kind == "dilated" && !(radius > 0))
      throw InputError(at + "radius_m must be positive for a dilated grain");
    if (kind != "polyhedron" && !(v[8] > 0))
      throw InputError(at + "sieve_m must be positive for a grain of kind " + kind);
    rows.push_back(
        {static_cast<int>(v[0]), {v[1], v[2], v[3]}, q.normalized(), v[8], kind, radius});
  }
  return rows;
}

PackedGrains read_csv(const std::string& path) {
  PackedGrains g;
  std::map<int, GrainShape> shapes;
  for (const Row& row : read_rows(path)) {
    const auto [at, fresh] = shapes.try_emplace(row.shape);
    if (fresh) at->second = read_shape(shape_path(path, row), row);
    add_posed(g, at->second, row.x, row.q, row.sieve);
  }
  return g;
}

}  // namespace

PackedGrains read_packing(const std::string& path) {
  const std::string kind = ending(path);
  if (kind != "off" && kind != "csv")
    throw InputError(path + ": unknown kind of packing; .csv and .off are read");
  const PackedGrains g = kind == "off" ? read_off(path) : read_csv(path);
  if (g.size() == 0) throw InputError(path + ": holds no grains");
  return g;
}

std::vector<std::string> packing_files(const std::string& path) {
  std::vector<std::string> files{path};
  if (ending(path) != "csv") return files;
  std::set<std::string> shapes;
  for (const Row& row : read_rows(path)) shapes.insert(shape_path(path, row));
  files.insert(files.end(), shapes.begin(), shapes.end());
  return files;
}

}  // namespace trackbed::dem
