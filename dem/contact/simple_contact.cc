#include "dem/contact/simple_contact.h"

#include "dem/contact/eight.h"
#include "dem/contact/overlap_simple.h"

namespace trackbed::dem {
namespace {

// Plain scalars: sums of a few products are quicker so than as small matrices.
struct Point {
  double x, y, z;
};
Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point operator*(double s, const Point& a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point point(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Point times(const Mat3& M, const Point& p) {
  return {M(0, 0) * p.x + M(0, 1) * p.y + M(0, 2) * p.z,
          M(1, 0) * p.x + M(1, 1) * p.y + M(1, 2) * p.z,
          M(2, 0) * p.x + M(2, 1) * p.y + M(2, 2) * p.z};
}
Point transposed_times(const Mat3& M, const Point& p) {
  return {M(0, 0) * p.x + M(1, 0) * p.y + M(2, 0) * p.z,
          M(0, 1) * p.x + M(1, 1) * p.y + M(2, 1) * p.z,
          M(0, 2) * p.x + M(1, 2) * p.y + M(2, 2) * p.z};
}

// Points of the body's frame lie inside all its planes by `clear`, those of `but` (bits) left out.
bool inside(const ConvexView& v, const double* x, const double* y, const double* z, int points,
            std::uint64_t but, double clear) {
  std::uint64_t outside = 0;
  for (int f = 0; f < v.faces; f += 8) {
    const Eight nx = Eight::load(v.nx + f), ny = Eight::load(v.ny + f), nz = Eight::load(v.nz + f);
    const Eight limit = Eight::load(v.offset + f) - Eight(clear);
    unsigned bits = 0;
    for (int k = 0; k < points; ++k)
      bits |= less(limit, fma(nx, Eight(x[k]), fma(ny, Eight(y[k]), nz * Eight(z[k]))));
    outside |= std::uint64_t(bits) << f;
  }
  return (outside & ~but & face_bits(v)) == 0;
}

// Of a polygon in a plane, corners relative to any point near: area, centroid, J/A.
struct PlaneMoments {
  double area, x, y, xx, yy, xy;
};

PlaneMoments plane_moments(const double* x, const double* y, int n) {
  double mean_x = 0, mean_y = 0;
  for (int k = 0; k < n; ++k) mean_x += x[k], mean_y += y[k];
  mean_x /= n, mean_y /= n;
  double sum = 0, sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;  // about the mean
  const double ax = x[0] - mean_x, ay = y[0] - mean_y;
  double bx = x[1] - mean_x, by = y[1] - mean_y;
  for (int k = 2; k < n; ++k) {
    const double cx = x[k] - mean_x, cy = y[k] - mean_y;
    const double w = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    const double tx = ax + bx + cx, ty = ay + by + cy;
    sum += w, sx += w * tx, sy += w * ty;
    xx += w * (tx * tx + ax * ax + bx * bx + cx * cx);
    yy += w * (ty * ty + ay * ay + by * by + cy * cy);
    xy += w * (tx * ty + ax * ay + bx * by + cx * cy);
    bx = cx, by = cy;
  }
  const double inverse = 1 / sum, dx = sx * inverse * (1. / 3), dy = sy * inverse * (1. / 3);
  const double r = inverse * (1. / 12);
  return {0.5 * sum,        mean_x + dx,      mean_y + dy,
          xx * r - dx * dx, yy * r - dy * dy, xy * r - dx * dy};
}

// An edge in world axes about its body's centre, and the two faces at it.
struct Edge {
  Point from, along, left, right;  // the latter two normals, body frame
  double left_offset, right_offset;
  std::uint64_t bits;
  bool found;

  Edge(const ConvexView& v, const Mat3& R, int vertex, int which) {
    const Star star(v, vertex);
    found = star.edges() > 0;
    if (!found) return;
    from = times(R, {star.at[0], star.at[1], star.at[2]});
    along = times(R, {star.x()[which], star.y()[which], star.z()[which]});
    const int l = star.left_face(which), r = star.right_face(which);
    left = times(R, {v.nx[l], v.ny[l], v.nz[l]}), left_offset = v.offset[l];
    right = times(R, {v.nx[r], v.ny[r], v.nz[r]}), right_offset = v.offset[r];
    bits = std::uint64_t(1) << l | std::uint64_t(1) << r;
  }
};

// Where an edge passes the two planes at another: through the left one at `left`, the right one at
// `right` (shares of the edge), entering by the first of them. `from` is where it starts about the
// other body's centre.
struct Passage {
  double left, right;
  bool found, enters_left;

  Passage(const Point& from, const Point& along, const Edge& other, double least) {
    const double fl = dot(other.left, from) - other.left_offset, rise_l = dot(other.left, along);
    const double fr = dot(other.right, from) - other.right_offset, rise_r = dot(other.right, along);
    const double tl = fl + rise_l, tr = fr + rise_r;
    left = -fl / rise_l, right = -fr / rise_r;
    enters_left = rise_l < 0;
    const double way = enters_left ? right - left : left - right, clear = kClear * least;
    const double least_l = enters_left ? -rise_l : rise_l, least_r = enters_left ? rise_r : -rise_r;
    found = (fl >= 0) != (tl >= 0) && (fr >= 0) != (tr >= 0) && least_l > least &&
            least_r > least && way * least_l > clear && way * least_r > clear;
  }
};

bool edge_on_edge(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                  const SimpleFeature& f, double least, SimpleContact& c) {
  const Edge ea(a, pa.R, f.a, f.a_edge), eb(b, pb.R, f.b, f.b_edge);
  if (!ea.found || !eb.found) return false;
  const Point ab = point(pb.x - pa.x), a_from_b = ea.from - ab, b_from_a = eb.from + ab;
  const Passage of_a(a_from_b, ea.along, eb, least), of_b(b_from_a, eb.along, ea, least);
  if (!of_a.found || !of_b.found) return false;
  const double in = of_a.enters_left ? of_a.left : of_a.right,
               out = of_a.enters_left ? of_a.right : of_a.left;
  const auto clear = [](const ConvexView& body, const Mat3& R, const Point& p, const Point& q,
                        std::uint64_t but) {
    const Point u = transposed_times(R, p), w = transposed_times(R, q);
    const double x[2] = {u.x, w.x}, y[2] = {u.y, w.y}, z[2] = {u.z, w.z};
    return inside(body, x, y, z, 2, but, 0);
  };
  if (!clear(b, pb.R, a_from_b + in * ea.along, a_from_b + out * ea.along, eb.bits) ||
      !clear(a, pa.R, b_from_a + of_b.left * eb.along, b_from_a + of_b.right * eb.along, ea.bits))
    return false;

  // Frame: third axis normal to both edges, origin where a's edge starts.
  const Vec3 normal = Vec3(ea.along.y * eb.along.z - ea.along.z * eb.along.y,
                           ea.along.z * eb.along.x - ea.along.x * eb.along.z,
                           ea.along.x * eb.along.y - ea.along.y * eb.along.x);
  const double size2 = normal.squaredNorm();
  if (!(size2 > 0)) return false;
  c.frame.axes = axes_along(normal / std::sqrt(size2));
  c.frame.origin = pa.x + Vec3(ea.from.x, ea.from.y, ea.from.z);
  const Mat3& W = c.frame.axes;
  const Point da = transposed_times(W, ea.along), db = transposed_times(W, eb.along),
              r = transposed_times(W, b_from_a - ea.from);
  const double height = r.z;
  // Corners p1, right, p2, left: the fan of a's two faces.
  const double x[4] = {in * da.x, r.x + of_b.right * db.x, out * da.x, r.x + of_b.left * db.x};
  const double y[4] = {in * da.y, r.y + of_b.right * db.y, out * da.y, r.y + of_b.left * db.y};
  const double twice =
      (x[2] - x[0]) * (y[3] - y[1]) - (y[2] - y[0]) * (x[3] - x[1]);  // vector area, z
  const double V = -twice * height / 6;
  if (!(V > 0)) return false;
  const double mx = 0.25 * (x[0] + x[1] + x[2] + x[3]), my = 0.25 * (y[0] + y[1] + y[2] + y[3]);
  double xx = 0, yy = 0, xy = 0;
  for (int k = 0; k < 4; ++k) {
    const double ux = x[k] - mx, uy = y[k] - my;
    xx += ux * ux, yy += uy * uy, xy += ux * uy;
    c.corner[k] = Vec3(x[k], y[k], k % 2 ? height : 0);
  }
  const double half = height / 2;  // of b's corners over the mean; a's are below
  const double xz = half * (x[1] + x[3] - x[0] - x[2]), yz = half * (y[1] + y[3] - y[0] - y[2]);
  const double w = V / 20;
  c.shape.volume = V;
  c.shape.centroid = Vec3(mx, my, half);
  c.shape.second_moment << w * xx, w * xy, w * xz,  //
      w * xy, w * yy, w * yz,                       //
      w * xz, w * yz, w * height * height;
  c.shape.depth = std::abs(height);
  c.shape.area = Vec3(0, 0, twice / 2);
  c.corners = 4;
  c.of_a = true;
  return true;
}

}  // namespace

bool vertex_in_face(const ConvexView& own, const Pose& own_pose, int v, const ConvexView& other,
                    const Pose& other_pose, int face, double least, SimpleContact& c) {
  const Star star(own, v);
  const int edges = star.edges();
  if (edges == 0) return false;
  // Frame: the face's, origin at the other body's until the vertex is known.
  const Mat3 of_face = axes_along(Vec3(other.nx[face], other.ny[face], other.nz[face]));
  c.frame.axes = other_pose.R * of_face;
  const Mat3 M = c.frame.axes.transpose() * own_pose.R;
  const Point arm = times(own_pose.R, {star.at[0], star.at[1], star.at[2]});
  const Point place = arm + point(own_pose.x - other_pose.x);
  const Point tip = transposed_times(c.frame.axes, place);
  const double depth = other.offset[face] - tip.z;
  if (!(depth > kClear * least)) return false;

  // Edges, eight at a time; lanes beyond the last hold something finite, not used.
  const Eight ex = Eight::load(star.x()), ey = Eight::load(star.y()), ez = Eight::load(star.z());
  const auto row = [&](const Mat3& A, int r, Eight x, Eight y, Eight z, double t) {
    return fma(Eight(A(r, 0)), x, fma(Eight(A(r, 1)), y, fma(Eight(A(r, 2)), z, Eight(t))));
  };
  const unsigned all = (1u << edges) - 1;
  const Eight rise = row(M, 2, ex, ey, ez, 0);
  const double most = depth > least ? depth : least;  // the other end at or above the face
  if ((less(rise, Eight(most)) | less_equal(rise, Eight(least))) & all) return false;
  const Eight t = divide_where(all, Eight(depth), rise);
  const Eight gx = t * row(M, 0, ex, ey, ez, 0), gy = t * row(M, 1, ex, ey, ez, 0);

  // The crossings, and the vertex after them, in the other's frame.
  alignas(64) double px[8], py[8], pz[8], x[8], y[8];
  const Eight fx = gx + Eight(tip.x), fy = gy + Eight(tip.y), fz(other.offset[face]);
  row(of_face, 0, fx, fy, fz, 0).store(px);
  row(of_face, 1, fx, fy, fz, 0).store(py);
  row(of_face, 2, fx, fy, fz, 0).store(pz);
  const Point last = transposed_times(other_pose.R, place);
  const std::uint64_t but = std::uint64_t(1) << face;
  if (!inside(other, &last.x, &last.y, &last.z, 1, but, kClear * least)) return false;
  if (!inside(other, px, py, pz, edges, but, 0)) return false;

  // Edges run clockwise seen from outside their body, so clockwise on the face.
  gx.store(px), gy.store(py);
  for (int k = 0; k < edges; ++k) x[k] = px[edges - 1 - k], y[k] = py[edges - 1 - k];
  const PlaneMoments base = plane_moments(x, y, edges);
  if (!(base.area > 0)) return false;
  const double V = base.area * depth * (1. / 3), j = 0.6 * V, s = 0.0375 * V;
  const double xz = s * base.x * depth, yz = s * base.y * depth,
               xy = j * base.xy + s * base.x * base.y;
  c.shape.volume = V;
  c.shape.centroid = Vec3(0.75 * base.x, 0.75 * base.y, 0.75 * depth);
  c.shape.second_moment << j * base.xx + s * base.x * base.x, xy, xz,  //
      xy, j * base.yy + s * base.y * base.y, yz,                       //
      xz, yz, s * depth * depth;
  c.shape.depth = depth;
  c.corners = edges;
  for (int k = 0; k < edges; ++k) c.corner[k] = Vec3(x[k], y[k], depth);
  c.shape.area = Vec3(0, 0, base.area);
  c.frame.origin = own_pose.x + Vec3(arm.x, arm.y, arm.z);
  return true;
}

bool simple_contact(const ConvexView& a, const Pose& pa, const ConvexView& b, const Pose& pb,
                    const SimpleFeature& f, SimpleContact& c) {
  if (!a.stars || !b.stars || !a.planes_padded || !b.planes_padded) return false;
  const double least = kLeastRise * (a.radius < b.radius ? a.radius : b.radius);
  if (f.kind == SimpleFeature::edges) return edge_on_edge(a, pa, b, pb, f, least, c);
  c.of_a = f.kind == SimpleFeature::vertex_of_b;  // the face's body
  if (c.of_a) return vertex_in_face(b, pb, f.b, a, pa, f.a, least, c);
  if (!vertex_in_face(a, pa, f.a, b, pb, f.b, least, c)) return false;
  c.shape.area.z() = -c.shape.area.z();  // that of a's faces
  return true;
}

}  // namespace trackbed::dem
