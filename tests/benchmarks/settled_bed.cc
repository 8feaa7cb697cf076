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
Scene loose_grains(int count) {
  Scene s(2e7, .1);
  const std::vector<GrainShape> grains = ballast(count);
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

// Place, turn and radius (to know the grain again) of each; contacts find their forces anew.
std::string file_name(const BedSettings& b) {
  char name[80];
  std::snprintf(name, sizeof name, "/bed_%d_%.0e_%.2f.txt", b.grains, b.modulus, b.friction);
  return b.folder + name;
}

void write_places(const Scene& s, const std::string& name) {
  std::FILE* file = std::fopen((name + ".new").c_str(), "w");
  if (!file) return;
  for (int i = 0; i < s.bodies.grains; ++i) {
    const Vec3& x = s.bodies.x[i];
    const Quat& q = s.bodies.q[i];
    std::fprintf(file, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", x.x(), x.y(), x.z(),
                 q.w(), q.x(), q.y(), q.z(), s.shapes.shape(s.bodies.shape[i]).radius);
  }
  if (std::fclose(file) == 0) std::rename((name + ".new").c_str(), name.c_str());
}

// False when the file is missing or of other grains.
bool read_places(Scene& s, const std::string& name) {
  std::ifstream file(name);
  Bodies& b = s.bodies;
  for (int i = 0; i < b.grains; ++i) {
    double v[8];
    for (double& value : v)
      if (!(file >> value)) return false;
    if (v[7] != s.shapes.shape(b.shape[i]).radius) return false;
    b.x[i] = Vec3(v[0], v[1], v[2]);
    b.q[i] = Quat(v[3], v[4], v[5], v[6]);
    b.R[i] = b.q[i].toRotationMatrix();
  }
  return true;
}

}  // namespace

Scene loose_bed(int grains) {
  Scene s = loose_grains(grains);
  add_base(s);
  return s;
}

Scene settled_bed(const BedSettings& b) {
  const Scene loose = loose_grains(b.grains);
  Scene s = loose;
  const bool kept = !b.folder.empty() && read_places(s, file_name(b));
  if (!kept) s = loose;
  add_base(s);
  s.context.threads = b.threads;
  if (!kept) {
    for (int k = 0; k < 4; ++k) settle(s, 5e7, .1, .2, .15);
    settle(s, 5e7, .1, .7, .15);
    settle(s, 3e8, b.friction, .7, .03);
    settle(s, b.modulus, b.friction, .7, .02);
    if (!b.folder.empty()) write_places(s, file_name(b));
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
