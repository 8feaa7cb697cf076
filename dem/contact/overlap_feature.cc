#include "dem/contact/overlap_feature.h"

#include "dem/contact/eight.h"
#include "dem/contact/overlap_simple.h"

namespace trackbed::dem {
namespace {

struct Point {
  double x, y, z;
};

struct Plane {
  double nx, ny, nz, offset;
  double distance(const Point& p) const { return nx * p.x + ny * p.y + nz * p.z - offset; }
};

Point between(const Point& p, const Point& q, double t) {
  return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
}

Point vertex(const PlacedBody& body, int i) {
  const ConvexView& v = body.view;
  const Mat3& M = body.M;
  const double x = v.x[i], y = v.y[i], z = v.z[i];
  return {M(0, 0) * x + M(0, 1) * y + M(0, 2) * z + body.t.x(),
          M(1, 0) * x + M(1, 1) * y + M(1, 2) * z + body.t.y(),
          M(2, 0) * x + M(2, 1) * y + M(2, 2) * z + body.t.z()};
}

Plane plane(const PlacedBody& body, int f) {
  const ConvexView& v = body.view;
  const Mat3& M = body.M;
  const double x = v.nx[f], y = v.ny[f], z = v.nz[f];
  Plane p = {M(0, 0) * x + M(0, 1) * y + M(0, 2) * z, M(1, 0) * x + M(1, 1) * y + M(1, 2) * z,
             M(2, 0) * x + M(2, 1) * y + M(2, 2) * z, v.offset[f]};
  p.offset += p.nx * body.t.x() + p.ny * body.t.y() + p.nz * body.t.z();
  return p;
}

// All points lie inside all planes of the body by `clear`, those of `but` (bits) left out.
template <int points>
bool inside(const PlacedBody& body, const Point* const (&p)[points], std::uint64_t but,
            double clear) {
  const ConvexView& v = body.view;
  const Mat3& M = body.M;
  Eight x[points], y[points], z[points];
  for (int k = 0; k < points; ++k) {  // in the body's frame
    const double rx = p[k]->x - body.t.x(), ry = p[k]->y - body.t.y(), rz = p[k]->z - body.t.z();
    x[k] = Eight(M(0, 0) * rx + M(1, 0) * ry + M(2, 0) * rz);
    y[k] = Eight(M(0, 1) * rx + M(1, 1) * ry + M(2, 1) * rz);
    z[k] = Eight(M(0, 2) * rx + M(1, 2) * ry + M(2, 2) * rz);
  }
  std::uint64_t outside = 0;
  for (int f = 0; f < v.faces; f += 8) {
    const Eight nx = Eight::load(v.nx + f), ny = Eight::load(v.ny + f), nz = Eight::load(v.nz + f);
    const Eight limit = Eight::load(v.offset + f) - Eight(clear);
    unsigned bits = 0;
    for (int k = 0; k < points; ++k) bits |= less(limit, fma(nx, x[k], fma(ny, y[k], nz * z[k])));
    outside |= std::uint64_t(bits) << f;
  }
  return (outside & ~but & face_bits(v)) == 0;
}

void add(int face, const Point& p, const Point& q, const Point& r, OverlapWorkspace& work,
         std::vector<OverlapPiece>& pieces) {
  const double x[3] = {p.x, q.x, r.x}, y[3] = {p.y, q.y, r.y}, z[3] = {p.z, q.z, r.z};
  add_piece(face, 3, x, y, z, work, pieces);
}

// Appends the pieces and returns the number of corners, or 0.
int vertex_in_face(const PlacedBody& own, int v, const PlacedBody& other, int face, double least,
                   OverlapWorkspace& work, std::vector<OverlapPiece>& own_pieces,
                   std::vector<OverlapPiece>& other_pieces) {
  constexpr int kEdges = 8;
  const ConvexView& view = own.view;
  const int begin = view.neighbor_begin[v], edges = view.neighbor_begin[v + 1] - begin;
  if (edges > kEdges) return 0;
  const Point tip = vertex(own, v);
  const Plane cut = plane(other, face);
  const double depth = -cut.distance(tip);
  if (!(depth > kClear * least)) return 0;
  const std::uint64_t but = std::uint64_t(1) << face;
  const Point* const first[1] = {&tip};
  if (!inside(other, first, but, kClear * least)) return 0;
  double x[kEdges], y[kEdges], z[kEdges];
  for (int k = 0; k < edges; ++k) {
    const Point end = vertex(own, view.neighbor[begin + k]);
    const double height = cut.distance(end), rise = height + depth;
    if (!(height >= 0) || !(rise > least)) return 0;
    const Point p = between(tip, end, depth / rise);
    const Point* const crossing[1] = {&p};
    if (!inside(other, crossing, but, 0)) return 0;
    x[edges - 1 - k] = p.x, y[edges - 1 - k] = p.y, z[edges - 1 - k] = p.z;
  }
  for (int k = 0; k < edges; ++k) {
    const int i = edges - 1 - k, j = i > 0 ? i - 1 : edges - 1;
    add(view.left_face[begin + k], tip, {x[i], y[i], z[i]}, {x[j], y[j], z[j]}, work, own_pieces);
  }
  add_piece(face, edges, x, y, z, work, other_pieces);
  return edges + 1;
}

struct Edge {
  Point from, to;
  int left, right;
  Plane left_plane, right_plane;

  Edge(const PlacedBody& body, int vertex_index, int which) {
    const ConvexView& v = body.view;
    const int begin = v.neighbor_begin[vertex_index], end = v.neighbor_begin[vertex_index + 1];
    const int k = begin + which;
    from = vertex(body, vertex_index), to = vertex(body, v.neighbor[k]);
    left = v.left_face[k], right = v.left_face[k > begin ? k - 1 : end - 1];
    left_plane = plane(body, left), right_plane = plane(body, right);
  }
};

// Where an edge passes the two planes at another: through the left one at `left`, the right one at
// `right` (shares of the edge), entering by the first of them.
struct Passage {
  double left, right;
  bool found, enters_left;

  Passage(const Edge& edge, const Edge& other, double least) {
    const double fl = other.left_plane.distance(edge.from), tl = other.left_plane.distance(edge.to);
    const double fr = other.right_plane.distance(edge.from),
                 tr = other.right_plane.distance(edge.to);
    const double rise_l = tl - fl, rise_r = tr - fr;
    left = -fl / rise_l, right = -fr / rise_r;
    enters_left = rise_l < 0;
    const double inside = enters_left ? right - left : left - right, clear = kClear * least;
    const double least_l = enters_left ? -rise_l : rise_l, least_r = enters_left ? rise_r : -rise_r;
    found = (fl >= 0) != (tl >= 0) && (fr >= 0) != (tr >= 0) && least_l > least &&
            least_r > least && inside * least_l > clear && inside * least_r > clear;
  }
  double in() const { return enters_left ? left : right; }
  double out() const { return enters_left ? right : left; }
};

bool edge_on_edge(const PlacedBody& a, const PlacedBody& b, const SimpleFeature& f, double least,
                  OverlapWorkspace& work) {
  const Edge ea(a, f.a, f.a_edge), eb(b, f.b, f.b_edge);
  const Passage of_a(ea, eb, least), of_b(eb, ea, least);
  if (!of_a.found || !of_b.found) return false;
  const Point p1 = between(ea.from, ea.to, of_a.in()), p2 = between(ea.from, ea.to, of_a.out());
  const Point left = between(eb.from, eb.to, of_b.left),
              right = between(eb.from, eb.to, of_b.right);
  const auto bits = [](const Edge& e) {
    return std::uint64_t(1) << e.left | std::uint64_t(1) << e.right;
  };
  const Point *const on_a[2] = {&p1, &p2}, *const on_b[2] = {&left, &right};
  if (!inside(b, on_a, bits(eb), 0) || !inside(a, on_b, bits(ea), 0)) return false;
  const int in = of_a.enters_left ? eb.left : eb.right, out = of_a.enters_left ? eb.right : eb.left;
  add(ea.left, p1, p2, left, work, work.a_pieces);
  add(ea.right, p2, p1, right, work, work.a_pieces);
  add(in, p1, left, right, work, work.b_pieces);
  add(out, p2, right, left, work, work.b_pieces);
  return true;
}

}  // namespace

int clip_feature(const PlacedBody& a, const PlacedBody& b, const SimpleFeature& f,
                 OverlapWorkspace& work) {
  const double least = kLeastRise * (a.view.radius < b.view.radius ? a.view.radius : b.view.radius);
  if (f.kind == SimpleFeature::edges) return edge_on_edge(a, b, f, least, work) ? 4 : 0;
  if (f.kind == SimpleFeature::vertex_of_a)
    return vertex_in_face(a, f.a, b, f.b, least, work, work.a_pieces, work.b_pieces);
  return vertex_in_face(b, f.b, a, f.a, least, work, work.b_pieces, work.a_pieces);
}

}  // namespace trackbed::dem
