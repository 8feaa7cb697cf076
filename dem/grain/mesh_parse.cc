#include "dem/grain/mesh_parse.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include "base/error.h"

namespace trackbed::dem {
namespace {

// Words of a text line by line, comments (#) and empty lines skipped; knows where it is.
class Lines {
 public:
  Lines(const std::string& path, const std::string& text) : path_(path), in_(text) {}

  bool next() {
    std::string line;
    while (std::getline(in_, line)) {
      ++number_;
      words_.clear();
      at_ = 0;
      std::istringstream split(line.substr(0, line.find('#')));
      for (std::string word; split >> word;) words_.push_back(word);
      if (!words_.empty()) return true;
    }
    return false;
  }
  bool more() const { return at_ < words_.size(); }
  const std::string& word() {
    if (!more()) fail("the line ends too early");
    return words_[at_++];
  }
  double number() {
    const std::string& w = word();
    char* end = nullptr;
    const double value = std::strtod(w.c_str(), &end);
    if (*end != 0) fail("'" + w + "' is not a number");
    if (!std::isfinite(value)) fail("coordinate '" + w + "' is not a finite number");
    return value;
  }
  long integer() {
    const std::string& w = word();
    char* end = nullptr;
    const long value = std::strtol(w.c_str(), &end, 10);
    if (*end != 0) fail("'" + w + "' is not a whole number");
    return value;
  }
  Vec3 point() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(path_ + ": line " + std::to_string(number_) + ": " + problem);
  }

 private:
  std::string path_;
  std::istringstream in_;
  std::vector<std::string> words_;
  size_t at_ = 0;
  int number_ = 0;
};

[[noreturn]] void ends_early(const std::string& path) {
  throw InputError(path + ": the file ends too early");
}

RawMesh parse_binary_stl(const std::string& path, const std::string& bytes, std::uint32_t count) {
  RawMesh mesh;
  mesh.single_precision = true;
  for (std::uint32_t t = 0; t < count; ++t) {
    float values[12];
    std::memcpy(values, bytes.data() + 84 + 50 * size_t(t), sizeof values);
    for (int corner = 1; corner < 4; ++corner) {
      const Vec3 p(values[3 * corner], values[3 * corner + 1], values[3 * corner + 2]);
      if (!p.allFinite())
        throw InputError(path + ": triangle " + std::to_string(t + 1) +
                         ": a coordinate is not a finite number");
      mesh.vertices.push_back(p);
    }
    const int last = int(mesh.vertices.size());
    mesh.faces.push_back({last - 3, last - 2, last - 1});
  }
  return mesh;
}

}  // namespace

RawMesh parse_off(const std::string& path, const std::string& text) {
  Lines lines(path, text);
  if (!lines.next()) ends_early(path);
  if (lines.word() != "OFF") lines.fail("the file does not start with OFF");
  if (!lines.more() && !lines.next()) ends_early(path);
  const long vertices = lines.integer(), faces = lines.integer();
  if (vertices < 0 || faces < 0) lines.fail("negative number of vertices or faces");
  RawMesh mesh;
  for (long v = 0; v < vertices; ++v) {
    if (!lines.next()) ends_early(path);
    mesh.vertices.push_back(lines.point());
  }
  for (long f = 0; f < faces; ++f) {
    if (!lines.next()) ends_early(path);
    const long corners = lines.integer();
    if (corners < 3) lines.fail("a face has fewer than 3 vertices");
    std::vector<int> face;
    for (long k = 0; k < corners; ++k) {
      const long index = lines.integer();
      if (index < 0 || index >= vertices)
        lines.fail("vertex " + std::to_string(index) + " of " + std::to_string(vertices) +
                   " does not exist");
      face.push_back(int(index));
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

RawMesh parse_obj(const std::string& path, const std::string& text) {
  Lines lines(path, text);
  RawMesh mesh;
  while (lines.next()) {
    const std::string kind = lines.word();
    if (kind == "v") mesh.vertices.push_back(lines.point());
    if (kind != "f") continue;
    std::vector<int> face;
    while (lines.more()) {
      const std::string corner = lines.word();  // vertex[/texture[/normal]]
      char* end = nullptr;
      const long index = std::strtol(corner.c_str(), &end, 10), n = long(mesh.vertices.size());
      if (end == corner.c_str() || (*end != 0 && *end != '/'))
        lines.fail("'" + corner + "' is not a vertex index");
      const long v = index > 0 ? index - 1 : n + index;  // negative: counted from the last
      if (index == 0 || v < 0 || v >= n)
        lines.fail("vertex " + std::to_string(index) + " of " + std::to_string(n) +
                   " does not exist");
      face.push_back(int(v));
    }
    if (face.size() < 3) lines.fail("a face has fewer than 3 vertices");
    mesh.faces.push_back(face);
  }
  return mesh;
}

RawMesh parse_stl(const std::string& path, const std::string& text) {
  if (text.size() >= 84) {
    std::uint32_t count = 0;
    std::memcpy(&count, text.data() + 80, 4);
    if (text.size() == 84 + 50 * std::uint64_t(count)) return parse_binary_stl(path, text, count);
  }
  if (text.compare(0, 5, "solid") != 0)
    throw InputError(path +
                     ": neither ASCII STL (starts with 'solid') nor binary STL of its length");
  Lines lines(path, text);
  RawMesh mesh;
  mesh.single_precision = true;
  std::vector<int> loop;
  bool ended = false;
  while (lines.next()) {
    const std::string word = lines.word();
    if (word == "vertex") {
      loop.push_back(int(mesh.vertices.size()));
      mesh.vertices.push_back(lines.point());
    } else if (word == "endloop") {
      if (loop.size() != 3)
        lines.fail("a facet has " + std::to_string(loop.size()) + " vertices, not 3");
      mesh.faces.push_back(loop);
      loop.clear();
    } else if (word == "endsolid") {
      ended = true;
    }
  }
  if (!ended || !loop.empty()) ends_early(path);
  return mesh;
}

}  // namespace trackbed::dem
