#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "base/error.h"
#include "dem/grain/off_io.h"
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

// A body in its own frame as a grain whose frame stands at x, turned by q.
void add_posed(PackedGrains& g, const Polyhedron& body, const Vec3& x, const Quat& q,
               double sieve) {
  GrainShape s = make_grain_shape(body);
  s.sieve_size = sieve;
  g.add(s, x + q * s.origin, (q * s.turn).normalized());
}

PackedGrains read_off(const std::string& path) {
  PackedGrains g;
  for (const Polyhedron& body : read_solids(path))
    add_posed(g, body, Vec3::Zero(), Quat::Identity(), 0);
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

std::string shape_file(const std::string& csv, int shape) {
  return csv.substr(0, csv.size() - 4) + "_shapes/" + std::to_string(shape) + ".off";
}

struct Row {
  int shape;
  Vec3 x;
  Quat q;
  double sieve;
};

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
  std::vector<Row> rows;
  for (int number = 2; std::getline(text, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::string at = path + ": line " + std::to_string(number) + ": ";
    const std::vector<std::string> cells = split(line);
    double v[9];
    for (int k = 0; k < 9; ++k) {
      const std::string cell = column[k] < static_cast<int>(cells.size()) ? cells[column[k]] : "";
      char* end = nullptr;
      v[k] = std::strtod(cell.c_str(), &end);
      if (cell.empty() || *end != '\0' || !std::isfinite(v[k]))
        throw InputError(at + names[k] + " = '" + cell + "' is not a number");
    }
    const Quat q(v[4], v[5], v[6], v[7]);
    if (std::abs(q.norm() - 1) > 1e-6) throw InputError(at + "the quaternion's length is not 1");
    if (v[0] < 0 || v[0] != std::floor(v[0]) || v[0] > 1e9)
      throw InputError(at + "shape is not a whole number");
    rows.push_back({static_cast<int>(v[0]), {v[1], v[2], v[3]}, q.normalized(), v[8]});
  }
  return rows;
}

PackedGrains read_csv(const std::string& path) {
  PackedGrains g;
  std::map<int, Polyhedron> bodies;
  for (const Row& row : read_rows(path)) {
    const auto [at, fresh] = bodies.try_emplace(row.shape);
    if (fresh) at->second = read_solid(shape_file(path, row.shape));
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
  std::set<int> shapes;
  for (const Row& row : read_rows(path)) shapes.insert(row.shape);
  for (const int k : shapes) files.push_back(shape_file(path, k));
  return files;
}

}  // namespace trackbed::dem
