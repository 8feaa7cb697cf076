#include "settled_bed.h"

#include <cstdio>
#include <fstream>

#include "dem/grain/random.h"
#include "dem/grain/voronoi.h"
#include "dem/packing/lower.h"
#include "dem/packing/place.h"

namespace trackbed::dem {
namespace {

constexpr double kDensity = 2600;

std::vector<GrainShape> ballast(int count) {
  VoronoiParameters p;
  p.count = count + count / 4 + 100;
  std::vector<GrainShape> grains;
  Random random(3);
  while (static_cast<int>(grains.size()) < count) {
    for (const Polyhedron& g : voronoi_grains(p))
      if (g.vertices.size() >= 14 && g.vertices.size() <= 20 &&
          static_cast<int>(grains.size()) < count)
        grains.push_back(scaled(make_grain_shape(g), random.uniform(.024, .052)));
    ++p.seed;
  }
  return grains;
}

std::vector<GrainShape> spheres(int count) {
  std::vector<GrainShape> grains;
  Random random(3);
  for (int k = 0; k < count; ++k) grains.push_back(sphere_shape(random.uniform(.018, .027)));
  return grains;
}

PairMaterial material(double modulus, double friction) {
  PairMaterial m;
  m.modulus = modulus, m.friction = friction, m.tangential_ratio = .25;
  return m;
}

void settle(Scene& s, double modulus, double friction, double damping, double time) {
  s.materials.set(0, 0, material(modulus, friction));
  s.context.local_damping = damping;
  s.prepare();
  s.context.dt = .4 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  s.run(s.time + time);
}

// Grains only, loose, in a periodic column as high as wide once settled.
Scene loose_grains(const std::vector<GrainShape>& grains) {
  Scene s(2e7, .1);
  const int count = static_cast<int>(grains.size());
  double volume = 0;
  std::vector<double> radii;
  for (const GrainShape& g : grains) volume += g.volume, radii.push_back(g.radius);
  const double width = std::cbrt(volume / .58);
  s.context.period = Vec3(width, width, 0);
  PlacementSpace space;
  space.low = Vec3::Zero(), space.high = Vec3(width, width, width), space.period = s.context.period;
  const Placement at = place_loose(radii, space, {}, 40, 5);
  for (int i = 0; i < count; ++i)
    add_grain(s.bodies, s.shapes, s.shapes.add(grains[i]), 0, kDensity, at.centre[i], at.turn[i]);
  lower_grains(s.bodies, s.shapes, 0, 0, s.context.period, 1e-4);
  return s;
}

void add_base(Scene& s) {
  const Vec3 p = s.context.period;
  add_container(s.bodies, s.shapes, Vec3::Zero(), p + Vec3(0, 0, 1), 3 * p.x(), 0, kBase);
}

// Each grain's shape, place and turn, so that reading needs no hulls (nor exact arithmetic, which
// instruction counters do not follow); contacts find their forces anew.
std::string file_name(const BedSettings& b) {
  char name[80];
  std::snprintf(name, sizeof name, "/settled_%d_%.0e_%.2f.txt", b.grains, b.modulus, b.friction);
  return b.folder + name;
}

void write_bed(const Scene& s, const std::string& name) {
  std::ofstream file(name + ".new");
  file.precision(17);
  const auto put = [&file](const auto& v) {
    for (int k = 0; k < v.size(); ++k) file << ' ' << v[k];
  };
  put(s.context.period);
  for (int i = 0; i < s.bodies.grains; ++i) {
    const GrainShape& g = s.shapes.shape(s.bodies.shape[i]);
    file << '\n' << g.body.vertices.size() << ' ' << g.body.faces.size();
    put(s.bodies.x[i]), put(s.bodies.q[i].coeffs()), put(g.inertia);
    file << ' ' << g.volume << ' ' << g.radius;
    for (const Vec3& v : g.body.vertices) put(v);
    for (const std::vector<int>& face : g.body.faces) {
      file << ' ' << face.size();
      for (int v : face) file << ' ' << v;
    }
  }
  file.close();
  if (file) std::rename((name + ".new").c_str(), name.c_str());
}

// False when the file is missing or short.
bool read_bed(Scene& s, int grains, const std::string& name) {
  std::ifstream file(name);
  const auto get = [&file](auto&& v) {
    for (int k = 0; k < v.size(); ++k) file >> v[k];
  };
  get(s.context.period);
  for (int i = 0; i < grains; ++i) {
    std::size_t vertices = 0, faces = 0;
    if (!(file >> vertices >> faces)) return false;
    GrainShape g;
    Vec3 x;
    Quat q;
    get(x), get(q.coeffs()), get(g.inertia);
    file >> g.volume >> g.radius;
    g.body.vertices.resize(vertices), g.body.faces.resize(faces);
    for (Vec3& v : g.body.vertices) get(v);
    for (std::vector<int>& face : g.body.faces) {
      std::size_t corners = 0;
      file >> corners;
      if (!file) return false;
      face.resize(corners);
      for (int& v : face) file >> v;
    }
    add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, kDensity, x, q);
  }
  return bool(file);
}

}  // namespace

Scene loose_bed(int grains) {
  Scene s = loose_grains(ballast(grains));
  add_base(s);
  return s;
}

Scene settled_bed(const BedSettings& b) {
  Scene kept(b.modulus, b.friction);
  const bool found = !b.spheres && !b.folder.empty() && read_bed(kept, b.grains, file_name(b));
  Scene s = found ? kept : loose_grains(b.spheres ? spheres(b.grains) : ballast(b.grains));
  add_base(s);
  s.context.threads = b.threads;
  if (b.spheres) {
    settle(s, 5e7, .1, .2, .3);
    settle(s, 5e7, b.friction, .7, .3);
    return s;
  }
  if (!found) {
    for (int k = 0; k < 4; ++k) settle(s, 5e7, .1, .2, .15);
    settle(s, 5e7, .1, .7, .15);
    settle(s, 3e8, b.friction, .7, .03);
    settle(s, b.modulus, b.friction, .7, .02);
    if (!b.folder.empty()) write_bed(s, file_name(b));
  }
  settle(s, b.modulus, b.friction, .8, 2e-3);  // friction finds its forces again
  return s;
}

Scene tiled(const Scene& bed, int copies_x, int copies_y) {
  Scene s = bed;
  s.shapes = {}, s.bodies = {}, s.pairs = {}, s.candidates = {};
  const Vec3 period = bed.context.period;
  s.context.period = Vec3(copies_x * period.x(), copies_y * period.y(), 0);
  const Bodies& from = bed.bodies;
  for (int k = 0; k < copies_x * copies_y; ++k) {
    const Vec3 shift(k % copies_x * period.x(), k / copies_x * period.y(), 0);
    for (int i = 0; i < from.grains; ++i)
      add_grain(s.bodies, s.shapes, s.shapes.add(bed.shapes.shape(from.shape[i])), 0, kDensity,
                from.x[i] + shift, from.q[i]);
  }
  add_base(s);
  s.prepare();
  return s;
}

}  // namespace trackbed::dem
