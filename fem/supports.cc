#include "fem/supports.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

std::vector<int> nodes_on(const Discretisation& body, int boundary) {
  std::vector<int> nodes;
  for (const Face& face : body.faces)
    if (face.boundary == boundary)
      nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.begin() + face.count);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

int axis_of(const Discretisation& body, const std::string& name, const std::string& boundary,
            int id) {
  int axis = -1;
  for (const Face& face : body.faces) {
    if (face.boundary != id) continue;
    for (const FacePoint& p : face_points(body, face)) {
      int here = -1;
      for (int d = 0; d < 3; ++d)
        if (std::abs(std::abs(p.normal[d]) - 1) < 1e-8) here = d;
      if (here < 0 || (axis >= 0 && here != axis))
        throw InputError(
            text(name, ": boundary '", boundary,
                 "': a roller must be a plane normal to x, y or z; use fixed or free"));
      axis = here;
    }
  }
  return axis;
}

// Joins the nodes of the upper side to those of the lower side.
void join(const Discretisation& body, const std::string& name, int axis,
          const std::vector<int>& low, const std::vector<int>& high, Unknowns& unknowns) {
  const int e = (axis + 1) % 3, f = (axis + 2) % 3;
  const auto refuse = [&](const std::string& why) {
    throw InputError(text(name, ": periodic along ", "xyz"[axis], ": ", why,
                          "; both sides must carry the same mesh"));
  };
  if (low.size() != high.size() || low.empty())
    refuse(text(low.size(), " and ", high.size(), " nodes on the two sides"));
  const double period = body.position[high[0]][axis] - body.position[low[0]][axis];
  const double tolerance = 1e-7 * std::abs(period);
  const auto order = [&](int a, int b) {
    const Vec &p = body.position[a], &q = body.position[b];
    return std::abs(p[e] - q[e]) > tolerance ? p[e] < q[e] : p[f] < q[f];
  };
  std::vector<int> one = low, two = high;
  std::sort(one.begin(), one.end(), order);
  std::sort(two.begin(), two.end(), order);
  for (std::size_t i = 0; i < one.size(); ++i) {
    const Vec &p = body.position[one[i]], &q = body.position[two[i]];
    if (std::abs(p[e] - q[e]) > tolerance || std::abs(p[f] - q[f]) > tolerance ||
        std::abs(q[axis] - p[axis] - period) > tolerance)
      refuse(text("no partner for the node at (", q[0], ", ", q[1], ", ", q[2], ")"));
    unknowns.same_as[two[i]] = one[i];
  }
  unknowns.period[axis] = period;
}

}  // namespace

int find_boundary(const Discretisation& body, const std::string& name, const std::string& what,
                  const std::string& boundary) {
  const auto found = body.boundaries.find(boundary);
  if (found == body.boundaries.end())
    throw InputError(
        text(name, ": ", what, ": the mesh has no boundary '", boundary, "'; it has ",
             body.boundaries.empty() ? "none with a name" : names_of(body.boundaries)));
  return found->second;
}

Unknowns number_unknowns(const Discretisation& body, const std::string& name,
                         const std::map<std::string, Support>& supports) {
  Unknowns unknowns;
  const int n = body.nodes();
  unknowns.of_node.assign(n, {0, 0, 0});
  unknowns.same_as.resize(n);
  for (int i = 0; i < n; ++i) unknowns.same_as[i] = i;

  for (const auto& [boundary, support] : supports) {
    const int id = find_boundary(body, name, "support", boundary);
    if (support == Support::fixed) {
      for (int node : nodes_on(body, id)) unknowns.of_node[node] = {-1, -1, -1};
    } else if (support == Support::roller) {
      const int axis = axis_of(body, name, boundary, id);
      for (int node : nodes_on(body, id)) unknowns.of_node[node][axis] = -1;
    } else if (support == Support::periodic) {
      const bool x = boundary == "x_min" || boundary == "x_max";
      if (!x && boundary != "y_min" && boundary != "y_max")
        throw InputError(
            text(name, ": boundary '", boundary,
                 "' cannot be periodic; allowed are x_min with x_max and y_min with y_max"));
      const std::string low = x ? "x_min" : "y_min", high = x ? "x_max" : "y_max";
      for (const std::string& side : {low, high})
        if (!supports.count(side) || supports.at(side) != Support::periodic)
          throw InputError(
              text(name, ": boundary '", boundary, "' is periodic, so '", side, "' must be too"));
      if (boundary == low)
        join(body, name, x ? 0 : 1, nodes_on(body, id),
             nodes_on(body, find_boundary(body, name, "support", high)), unknowns);
    }
  }
  // A corner may be the image of an image; then both directions of a held node are held in all
  // images.
  for (int i = 0; i < n; ++i)
    while (unknowns.same_as[unknowns.same_as[i]] != unknowns.same_as[i])
      unknowns.same_as[i] = unknowns.same_as[unknowns.same_as[i]];
  for (int i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d)
      if (unknowns.of_node[i][d] < 0) unknowns.of_node[unknowns.same_as[i]][d] = -1;
  for (int i = 0; i < n; ++i)
    if (unknowns.same_as[i] == i)
      for (int& unknown : unknowns.of_node[i])
        if (unknown >= 0) unknown = unknowns.count++;
  for (int i = 0; i < n; ++i) unknowns.of_node[i] = unknowns.of_node[unknowns.same_as[i]];
  if (unknowns.count == 0) throw InputError(name + ": every node is fixed; nothing can move");
  return unknowns;
}

std::string free_motion(const Discretisation& body, const Unknowns& unknowns,
                        const std::vector<Bed>& beds) {
  Vec centre{}, low = body.position[0], high = low;
  for (const Vec& x : body.position)
    for (int d = 0; d < 3; ++d) {
      centre[d] += x[d] / body.nodes();
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
  const double size = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  // Displacement along `direction` of the six motions at x, turns scaled by the size.
  const auto row = [&](const Vec& x, const Vec& n) {
    Vec r;
    for (int d = 0; d < 3; ++d) r[d] = (x[d] - centre[d]) / size;
    return std::array<double, 6>{n[0],
                                 n[1],
                                 n[2],
                                 r[1] * n[2] - r[2] * n[1],
                                 r[2] * n[0] - r[0] * n[2],
                                 r[0] * n[1] - r[1] * n[0]};
  };
  double gram[6][6] = {};
  const auto hold = [&](const std::array<double, 6>& g) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) gram[i][j] += g[i] * g[j];
  };
  const Vec unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0; i < body.nodes(); ++i)
    for (int d = 0; d < 3; ++d) {
      if (unknowns.of_node[i][d] < 0) hold(row(body.position[i], unit[d]));
      const int j = unknowns.same_as[i];
      if (j != i) {
        auto a = row(body.position[i], unit[d]);
        const auto b = row(body.position[j], unit[d]);
        for (int m = 0; m < 6; ++m) a[m] -= b[m];
        hold(a);
      }
    }
  for (const Bed& bed : beds) {
    const int id = body.boundaries.at(bed.boundary);
    for (const Face& face : body.faces) {
      if (face.boundary != id) continue;
      for (const FacePoint& p : face_points(body, face))
        for (int d = 0; d < 3; ++d) {
          Vec n, t;
          for (int c = 0; c < 3; ++c) {
            n[c] = p.normal[d] * p.normal[c];
            t[c] = (c == d) - n[c];
          }
          if (bed.has_springs(true)) hold(row(p.place, n));
          if (bed.has_springs(false)) hold(row(p.place, t));
        }
    }
  }
  static const char* names[6] = {"move along x", "move along y", "move along z",
                                 "turn about x", "turn about y", "turn about z"};
  double largest = 0;
  for (int i = 0; i < 6; ++i) largest = std::max(largest, gram[i][i]);
  for (int i = 0; i < 6; ++i)
    if (gram[i][i] <= 1e-12 * largest) return names[i];
  for (int k = 0; k < 6; ++k) {  // Cholesky with pivots: what is left over is a combined motion
    int pivot = k;
    for (int i = k; i < 6; ++i)
      if (gram[i][i] > gram[pivot][pivot]) pivot = i;
    if (gram[pivot][pivot] <= 1e-12 * largest) return "move and turn at once";
    for (int i = 0; i < 6; ++i) std::swap(gram[i][k], gram[i][pivot]);
    for (int i = 0; i < 6; ++i) std::swap(gram[k][i], gram[pivot][i]);
    for (int i = k + 1; i < 6; ++i)
      for (int j = k + 1; j < 6; ++j) gram[i][j] -= gram[i][k] * gram[k][j] / gram[k][k];
  }
  return "";
}

std::vector<std::vector<double>> rigid_motions(const Discretisation& body,
                                               const Unknowns& unknowns) {
  std::vector<std::vector<double>> motions(6, std::vector<double>(unknowns.count, 0.));
  for (int i = 0; i < body.nodes(); ++i) {
    const Vec& x = body.position[i];
    const Vec at[6] = {{1, 0, 0},        {0, 1, 0},        {0, 0, 1},
                       {0, -x[2], x[1]}, {x[2], 0, -x[0]}, {-x[1], x[0], 0}};
    for (int m = 0; m < 6; ++m)
      for (int d = 0; d < 3; ++d)
        if (const int k = unknowns.of_node[i][d]; k >= 0) motions[m][k] = at[m][d];
  }
  return motions;
}

}  // namespace trackbed::fem
