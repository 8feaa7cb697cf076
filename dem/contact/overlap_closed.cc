// Overlap as one closed surface: a cut by b's planes, one after the other, each cut's rim closed by
// a polygon of that plane.
//
// The other ways clip each face on its own. Where faces of both bodies coincide within rounding and
// neighbouring faces of one body are coplanar within rounding too, a point of that plane may then
// be counted by both bodies or by neither, and the volume is wrong by its share of the face. Here
// faces meet in common points, so the surface is closed whatever rounding does to a point's place.
#include <map>
#include <utility>

#include "dem/contact/overlap_clip.h"

namespace trackbed::dem {
namespace {

struct Face {
  int face;   ///< index in its body
  bool of_b;  ///< else of a
  std::vector<int> loop;
};

struct Solid {
  std::vector<Vec3> points;
  std::vector<Face> faces;
};

Solid solid_of(const PlacedBody& body) {
  const ConvexView& v = body.view;
  Solid s;
  for (int i = 0; i < v.vertices; ++i)
    s.points.push_back(body.M * Vec3(v.x[i], v.y[i], v.z[i]) + body.t);
  for (int f = 0; f < v.faces; ++f)
    s.faces.push_back({f, false, {v.loop + v.loop_begin[f], v.loop + v.loop_begin[f + 1]}});
  return s;
}

// Where the cut crosses edges: each edge has one point, whichever face asks for it.
class Crossings {
 public:
  Crossings(Solid& solid, const std::vector<double>& distance) : solid_(solid), d_(distance) {}

  int between(int in, int out) {
    const auto [found, added] = index_.try_emplace({in, out}, int(solid_.points.size()));
    if (added) {
      const double t = d_[in] < 0 ? d_[in] / (d_[in] - d_[out]) : 0;
      solid_.points.push_back(solid_.points[in] + t * (solid_.points[out] - solid_.points[in]));
    }
    return found->second;
  }

 private:
  Solid& solid_;
  const std::vector<double>& d_;
  std::map<std::pair<int, int>, int> index_;
};

// Keeps what lies below the plane (normal, offset) of b's face.
void cut(const Vec3& normal, double offset, double slack, int face, Solid& solid) {
  const std::size_t count = solid.points.size();
  std::vector<double> d(count);
  bool any = false;
  for (std::size_t i = 0; i < count; ++i) {
    d[i] = normal.dot(solid.points[i]) - offset;
    any = any || d[i] > slack;
  }
  if (!any) return;
  const auto outside = [&](int i) { return d[i] > slack; };
  Crossings crossings(solid, d);
  std::map<int, int> next;  // the rim, against the sense of the faces it belongs to
  std::vector<Face> kept;
  for (const Face& f : solid.faces) {
    Face rest{f.face, f.of_b, {}};
    const std::size_t n = f.loop.size();
    int left = -1, entered = -1;  // last point where the loop left; the first, if it entered before
    for (std::size_t k = 0; k < n; ++k) {
      const int i = f.loop[k], j = f.loop[(k + 1) % n];
      if (!outside(i)) rest.loop.push_back(i);
      if (outside(i) == outside(j)) continue;
      const int x = outside(i) ? crossings.between(j, i) : crossings.between(i, j);
      rest.loop.push_back(x);
      if (!outside(i))
        left = x;
      else if (left < 0)
        entered = x;
      else
        next[x] = left;
    }
    if (entered >= 0) next[entered] = left;
    if (!rest.loop.empty()) kept.push_back(std::move(rest));
  }
  while (!next.empty()) {
    Face cap{face, true, {}};
    for (auto at = next.begin(); at != next.end();) {
      cap.loop.push_back(at->first);
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
    kept.push_back(std::move(cap));
  }
  solid.faces = std::move(kept);
}

}  // namespace

void clip_closed(const PlacedBody& a, const PlacedBody& b, OverlapWorkspace& work) {
  const double slack = 1e-15 * (a.view.radius + b.view.radius);
  Solid solid = solid_of(a);
  const ConvexView& v = b.view;
  for (int f = 0; f < v.faces; ++f) {
    const Vec3 normal = b.M * Vec3(v.nx[f], v.ny[f], v.nz[f]);
    cut(normal, v.offset[f] + normal.dot(b.t), slack, f, solid);
  }
  std::vector<double> x, y, z;
  for (const Face& f : solid.faces) {
    if (f.loop.size() < 3) continue;
    x.clear(), y.clear(), z.clear();
    for (int i : f.loop) {
      const Vec3& p = solid.points[i];
      x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
    }
    add_piece(f.face, static_cast<int>(x.size()), x.data(), y.data(), z.data(), work,
              f.of_b ? work.b_pieces : work.a_pieces);
  }
}

}  // namespace trackbed::dem
