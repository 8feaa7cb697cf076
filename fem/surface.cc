#include "fem/surface.h"

#include <algorithm>
#include <map>

#include "fem/supports.h"

namespace trackbed::fem {
namespace {

using Line = std::pair<int, int>;

Line line(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

void mark_edges(SurfaceMesh& s) {
  std::map<Line, int> quads_at, quads_at_image;
  const auto each = [&](auto&& visit) {
    for (std::size_t q = 0; q < s.quads.size(); ++q)
      for (int k = 0; k < 4; ++k) visit(q, k, s.quads[q][k], s.quads[q][(k + 1) % 4]);
  };
  each([&](std::size_t, int, int a, int b) {
    ++quads_at[line(a, b)];
    ++quads_at_image[line(s.same_as[a], s.same_as[b])];
  });
  s.edges.resize(s.quads.size());
  each([&](std::size_t q, int k, int a, int b) {
    Edge edge = Edge::border;
    if (quads_at[line(a, b)] > 1)
      edge = Edge::inner;
    else if (quads_at_image[line(s.same_as[a], s.same_as[b])] > 1)
      edge = Edge::seam;
    s.edges[q][k] = edge;
  });
}

ContactSurface contact_surface(const Discretisation& body, const Unknowns& unknowns,
                               const std::string& name,
                               const std::vector<std::string>& boundaries) {
  ContactSurface out;
  std::vector<int> local(body.nodes(), -1);
  const auto number = [&](int node) {
    if (local[node] < 0) {
      local[node] = static_cast<int>(out.node.size());
      out.node.push_back(node);
      out.mesh.nodes.push_back(body.position[node]);
    }
    return local[node];
  };
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    const int id = find_boundary(body, name, "contact surface", boundaries[b]);
    for (const Face& face : body.faces) {
      if (face.boundary != id) continue;
      const int n = face.count == 4 ? 2 : 3;
      for (int j = 0; j + 1 < n; ++j)
        for (int i = 0; i + 1 < n; ++i) {
          const int k = j * n + i;
          out.mesh.quads.push_back({number(face.nodes[k]), number(face.nodes[k + 1]),
                                    number(face.nodes[k + n + 1]), number(face.nodes[k + n])});
          out.mesh.boundary.push_back(static_cast<int>(b));
        }
    }
  }
  const int count = static_cast<int>(out.node.size());
  // Images by unknown class; the class's first surface node stands for it.
  std::map<int, int> first;
  for (int i = 0; i < count; ++i) {
    const int root = unknowns.same_as[out.node[i]];
    if (local[root] >= 0)
      out.mesh.same_as.push_back(local[root]);
    else
      out.mesh.same_as.push_back(first.emplace(root, i).first->second);
  }
  out.mesh.period = unknowns.period;
  mark_edges(out.mesh);
  return out;
}

}  // namespace trackbed::fem
