#include "dem/contact/overlap_simple.h"

namespace trackbed::dem {
namespace {

struct Point {
  double x, y, z;
};

Point vertex(const Side& s, int i) { return {s.x[i], s.y[i], s.z[i]}; }

Point between(const Point& p, const Point& q, double t) {
  return {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
}

double distance(const Side& s, int face, const Point& p) {
  return s.nx[face] * p.x + s.ny[face] * p.y + s.nz[face] * p.z - s.offset[face];
}

bool inside(const Side& s, const Point& p, double clear) {
  for (std::uint64_t rest = s.faces; rest; rest &= rest - 1)
    if (!(distance(s, __builtin_ctzll(rest), p) < -clear)) return false;
  return true;
}

// The part of an edge inside the planes of `s` that may matter: from plane `in` at t0 to plane
// `out` at t1; -1 where it starts or ends inside.
struct Span {
  double t0 = 0, t1 = 1;
  int in = -1, out = -1;
  double rise_in = 0, rise_out = 0;

  // Both ends are clear of the other end's plane by more than rounding.
  bool clear(double by) const {
    const double t = t1 - t0;
    return -t * rise_in > by && t * rise_out > by;
  }
};

// False when nothing is inside or a plane is met at a grazing angle, rise <= least.
bool span(const Side& s, const Point& p, const Point& q, double least, Span& r) {
  for (std::uint64_t rest = s.faces; rest; rest &= rest - 1) {
    const int f = __builtin_ctzll(rest);
    const double dp = distance(s, f, p), dq = distance(s, f, q);
    if (dp < 0 && dq < 0) continue;
    if (dp >= 0 && dq >= 0) return false;
    const double rise = dq - dp;
    if (!(rise > least || rise < -least)) return false;
    const double t = -dp / rise;
    if (rise < 0) {
      if (t > r.t0) r.t0 = t, r.in = f, r.rise_in = rise;
    } else {
      if (t < r.t1) r.t1 = t, r.out = f, r.rise_out = rise;
    }
  }
  return r.t0 < r.t1;
}

void add(int face, const Point& p, const Point& q, const Point& r, OverlapWorkspace& work,
         std::vector<OverlapPiece>& pieces) {
  const double x[3] = {p.x, q.x, r.x}, y[3] = {p.y, q.y, r.y}, z[3] = {p.z, q.z, r.z};
  add_piece(face, 3, x, y, z, work, pieces);
}

// Vertex v of `own` in one face of `other`; returns the number of corners of the overlap, or 0.
int vertex_in_face(const ConvexView& view, const Side& own, int v, const Side& other, double least,
                   OverlapWorkspace& work, int& face, std::vector<OverlapPiece>& own_pieces,
                   std::vector<OverlapPiece>& other_pieces) {
  constexpr int kEdges = 8;
  const Point tip = vertex(own, v);
  if (!inside(other, tip, kClear * least)) return 0;
  const int begin = view.neighbor_begin[v], edges = view.neighbor_begin[v + 1] - begin;
  if (edges > kEdges) return 0;
  double x[kEdges], y[kEdges], z[kEdges];
  face = -1;
  for (int k = 0; k < edges; ++k) {
    const Point end = vertex(own, view.neighbor[begin + k]);
    Span s;
    if (!span(other, tip, end, least, s) || s.out < 0 || (face >= 0 && s.out != face)) return 0;
    face = s.out;
    const Point p = between(tip, end, s.t1);
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
  int from, which, to, left, right;
};

// f(edge) for the edges of the slab's part between two faces that may matter, until f is true.
template <class F>
bool any_edge(const ConvexView& v, const Side& s, F f) {
  for (std::uint64_t rest = s.kept; rest; rest &= rest - 1) {
    const int i = __builtin_ctzll(rest), begin = v.neighbor_begin[i], end = v.neighbor_begin[i + 1];
    int right = v.left_face[end - 1];  // of the first edge: what lies left of the one before
    for (int k = begin; k < end; ++k) {
      const int left = v.left_face[k], j = v.neighbor[k];
      const bool once = j > i || !(s.kept >> j & 1);
      if (once && (s.faces >> left & 1) && (s.faces >> right & 1) &&
          f(Edge{i, k - begin, j, left, right}))
        return true;
      right = left;
    }
  }
  return false;
}

bool edge_on_edge(const PlacedBody& a, const Side& sa, const PlacedBody& b, const Side& sb,
                  double least, OverlapWorkspace& work) {
  return any_edge(a.view, sa, [&](const Edge& ea) {
    const Point pa = vertex(sa, ea.from), qa = vertex(sa, ea.to);
    Span in_b;
    if (!span(sb, pa, qa, least, in_b) || !in_b.clear(kClear * least)) return false;
    return any_edge(b.view, sb, [&](const Edge& eb) {
      if (!(eb.left == in_b.in && eb.right == in_b.out) &&
          !(eb.left == in_b.out && eb.right == in_b.in))
        return false;
      const Point pb = vertex(sb, eb.from), qb = vertex(sb, eb.to);
      Span in_a;
      if (!span(sa, pb, qb, least, in_a) || !in_a.clear(kClear * least)) return false;
      const bool forward = in_a.in == ea.left && in_a.out == ea.right;
      if (!forward && !(in_a.in == ea.right && in_a.out == ea.left)) return false;
      const Point p1 = between(pa, qa, in_b.t0), p2 = between(pa, qa, in_b.t1);
      const Point left = between(pb, qb, forward ? in_a.t0 : in_a.t1);
      const Point right = between(pb, qb, forward ? in_a.t1 : in_a.t0);
      add(ea.left, p1, p2, left, work, work.a_pieces);
      add(ea.right, p2, p1, right, work, work.a_pieces);
      add(in_b.in, p1, left, right, work, work.b_pieces);
      add(in_b.out, p2, right, left, work, work.b_pieces);
      work.feature.code =
          SimpleFeature{SimpleFeature::edges, ea.from, ea.which, eb.from, eb.which}.code();
      return true;
    });
  });
}

int extreme(const Side& s, double up) {
  int best = -1;
  for (std::uint64_t rest = s.kept; rest; rest &= rest - 1) {
    const int i = __builtin_ctzll(rest);
    if (best < 0 || up * s.z[i] > up * s.z[best]) best = i;
  }
  return best;
}

}  // namespace

Clipped clip_simple(const PlacedBody& a, const Side& sa, const PlacedBody& b, const Side& sb,
                    OverlapWorkspace& work) {
  for (const ConvexView* v : {&a.view, &b.view})
    if (!v->neighbor || !v->left_face || !v->planes_padded) return Clipped::nothing;
  if (!sa.kept || !sb.kept) return Clipped::nothing;
  const double least = kLeastRise * (a.view.radius < b.view.radius ? a.view.radius : b.view.radius);
  int face = 0;
  const int top = extreme(sa, 1), bottom = extreme(sb, -1);
  int corners =
      vertex_in_face(a.view, sa, top, sb, least, work, face, work.a_pieces, work.b_pieces);
  if (corners) {
    work.feature.code = SimpleFeature{SimpleFeature::vertex_of_a, top, 0, face, 0}.code();
  } else {
    corners =
        vertex_in_face(b.view, sb, bottom, sa, least, work, face, work.b_pieces, work.a_pieces);
    if (corners)
      work.feature.code = SimpleFeature{SimpleFeature::vertex_of_b, face, 0, bottom, 0}.code();
  }
  if (!corners && edge_on_edge(a, sa, b, sb, least, work)) corners = 4;
  return corners == 0 ? Clipped::nothing : corners == 4 ? Clipped::tetrahedron : Clipped::pieces;
}

}  // namespace trackbed::dem
