// fuzz_pairs (options: fuzz_order.h): random pairs of convex grains, degenerate on purpose (lattice
// corners, coplanar faces, needles, grazing and full overlaps), each judged against CGAL's exact
// overlap, by symmetry of the two bodies, and by the law's force as gradient of its energy. An
// offender is written to DIR as two OFF files, both where they stood, to the last bit, and as a
// scene, DIR/*.prm, which `trackbed run` replays. Exit 1 if there is one.
#include <cmath>
#include <cstdio>

#include "dem/grain/off_io.h"
#include "tests/hard/fuzz_order.h"
#include "tests/hard/keep_pair.h"
#include "tests/verification/exact_overlap.h"

namespace trackbed::dem::test {
namespace {

constexpr double kVolume = 1e-10;   // relative
constexpr double kSymmetry = 1e-9;  // of the pressure's size
constexpr double kGradient = 1e-3;  // of the force
constexpr double kExchange = 1e-7;  // of the force

struct Found {
  Polyhedron a, b;  ///< both where they stand
  const char* what;
  double value;
};

double on_lattice(Random& random, int range) {
  return (double(random.below(2 * range + 1)) - range) / 8;
}

Polyhedron any_body(Random& random) {
  while (true) {
    try {
      const unsigned kind = random.below(4);
      if (kind == 0) return random_hull(random, 5 + static_cast<int>(random.below(16)));
      std::vector<Vec3> points;
      const int count = 5 + static_cast<int>(random.below(8));
      for (int i = 0; i < count; ++i)
        points.emplace_back(on_lattice(random, 4), on_lattice(random, 4), on_lattice(random, 4));
      if (kind == 2)  // needles and flakes, still exact
        for (Vec3& p : points) p.x() /= 64, p.y() /= random.below(2) ? 64 : 1;
      if (kind == 3)  // nearly coplanar, nearly equal corners
        for (Vec3& p : points) p += 1e-9 * random.direction();
      return convex_hull(points);
    } catch (const std::exception&) {
    }
  }
}

Polyhedron moved(Polyhedron body, const Vec3& x) {
  for (Vec3& p : body.vertices) p += x;
  return body;
}

Vec3 any_place(Random& random) {
  const unsigned kind = random.below(3);
  if (kind == 0) return random.uniform(0, 1.2) * random.direction();
  const Vec3 lattice(on_lattice(random, 4), on_lattice(random, 4), on_lattice(random, 4));
  return kind == 1 ? lattice : Vec3(lattice + 1e-9 * random.direction());
}

struct Judged : Contact {
  bool apart = false;
  double surface = 0;  ///< area of the overlap's boundary
};

Judged contact(const Polyhedron& a, const Polyhedron& b) {
  ShapeTable table;
  table.add(as_is(a)), table.add(as_is(b));
  const Pose still{Mat3::Identity(), Vec3::Zero()};
  Vec3 axis = Vec3::Zero();
  Judged c;
  c.apart = separating_axis(table.view(0), still, table.view(1), still, axis) > 0;
  if (c.apart) return c;
  OverlapWorkspace work;
  static_cast<Contact&>(c) = evaluate(table.view(0), still, table.view(1), still, axis,
                                      StoredEnergyLaw(), material(1), work);
  for (const OverlapPiece& piece : work.a_pieces) c.surface += piece.area.norm();
  for (const OverlapPiece& piece : work.b_pieces) c.surface += piece.area.norm();
  return c;
}

// How far corners lie off the plane of their face, and others above it: a hull merges facets that
// are coplanar within 1e-9 and leaves out corners that stand out by less, so that the solid is
// known no better.
double unevenness(const Polyhedron& body) {
  double most = 0;
  for (const auto& face : body.faces) {
    const std::array<int, 3> c = largest_triangle(body, face);
    const Vec3 p = body.vertices[c[0]];
    const Vec3 normal = (body.vertices[c[1]] - p).cross(body.vertices[c[2]] - p).normalized();
    for (const Vec3& v : body.vertices) most = std::max(most, normal.dot(v - p));
    for (int v : face) most = std::max(most, normal.dot(p - body.vertices[v]));
  }
  return most;
}

// Faces of both, with the same outward normal, that coincide within what the fuzzer shifts by.
bool faces_coincide(const Polyhedron& a, const Polyhedron& b) {
  const auto normal = [](const Polyhedron& body, const std::array<int, 3>& c) {
    const Vec3& p = body.vertices[c[0]];
    return Vec3((body.vertices[c[1]] - p).cross(body.vertices[c[2]] - p).normalized());
  };
  for (const auto& fa : a.faces) {
    const std::array<int, 3> ca = largest_triangle(a, fa);
    const Vec3 na = normal(a, ca);
    for (const auto& fb : b.faces) {
      const std::array<int, 3> cb = largest_triangle(b, fb);
      if (!(na.dot(normal(b, cb)) > 0)) continue;
      double least = HUGE_VAL, most = -HUGE_VAL;
      for (int v : cb) {
        const double height = na.dot(b.vertices[v] - a.vertices[ca[0]]);
        least = std::min(least, height), most = std::max(most, height);
      }
      if (least < 1e-8 && most > -1e-8) return true;
    }
  }
  return false;
}

// The force along axis k against the one-sided differences of the energy. Where faces of both
// bodies coincide, with the same outward normal, the energy has a kink: the overlap is bounded by
// whichever lies further in. Any value between the two slopes is a force then, and which one is
// taken depends on the order of the bodies; elsewhere the slopes are equal and the test is sharp.
struct Slopes {
  double least, most;

  Slopes(const Polyhedron& a, const Polyhedron& b, const Judged& c, int k) {
    const double h = 1e-5 * c.depth;
    const double up = (c.energy - contact(moved(a, h * Vec3::Unit(k)), b).energy) / h;
    const double down = (contact(moved(a, -h * Vec3::Unit(k)), b).energy - c.energy) / h;
    least = std::min(up, down), most = std::max(up, down);
  }
  double off(double force) const { return std::max({0.0, least - force, force - most}); }
};

// The pair at fault, or nothing: `what` is null.
Found judge(const Polyhedron& a, const Polyhedron& b, long& overlapping) {
  const Found fine{a, b, nullptr, 0};
  const Judged c = contact(a, b);
  if (!c.touching) return fine;
  const Pose still{Mat3::Identity(), Vec3::Zero()};
  std::vector<Plane> all = planes(a, still), more = planes(b, still);
  all.insert(all.end(), more.begin(), more.end());
  // Overlaps thinner than rounding of the corners have no volume to compare.
  const double size = std::cbrt(std::max(c.volume, 0.0));
  if (!(c.volume > 1e-12) || c.depth < 1e-6 * size) return fine;
  ++overlapping;
  const Exact exact = exact_overlap(all, c.centroid);
  if (exact.volume < 0) return {a, b, "the centroid is not inside of both", c.volume};
  // The volume of a layer as thick as the faces are uneven is not known.
  const double unknown = 2 * std::max(unevenness(a), unevenness(b)) * c.surface / exact.volume;
  const double off = std::abs(c.volume / exact.volume - 1);
  if (!(off < kVolume + unknown)) return {a, b, "volume against exact arithmetic", off};
  const double place = (c.centroid - exact.centroid).norm() / std::cbrt(exact.volume);
  if (!(place < 1e-6 + 10 * unknown)) return {a, b, "centroid against exact arithmetic", place};
  // Against the pressure's integral over the whole boundary, not the force: a body wholly inside
  // the other has none, its pressure balances itself.
  const double pressure = c.energy * c.surface / c.volume;
  const double sum = (c.force_a + c.force_b).norm() / pressure;
  if (!(sum < kSymmetry + unknown)) return {a, b, "forces of the two bodies", sum};
  const double scale = std::max(c.force_a.norm(), c.energy / c.depth);
  const Judged swapped = contact(b, a);
  const bool coincide = faces_coincide(a, b);
  for (int k = 0; k < 3; ++k) {
    const Slopes slopes(a, b, c, k);
    const double gap = slopes.off(c.force_a(k)) / scale;
    if (!(gap < kGradient)) return {a, b, "force as the energy's gradient", gap};
    const double other = slopes.off(swapped.force_b(k)) / scale;
    if (!(other < kGradient)) return {a, b, "force with the bodies exchanged", other};
    const double moved_by = std::abs(swapped.force_b(k) - c.force_a(k)) / scale;
    const double kink = (slopes.most - slopes.least) / scale;
    if (!(moved_by < (coincide ? kink + kGradient : kExchange)))
      return {a, b, "force with the bodies exchanged against its kink", moved_by};
  }
  return fine;
}

void keep(const Found& found, const std::string& stem) {
  std::filesystem::create_directories(std::filesystem::path(stem).parent_path());
  write_off(stem + "_a.off", found.a), write_off(stem + "_b.off", found.b);
  PackedGrains pair;
  for (const Polyhedron* body : {&found.a, &found.b}) {
    const GrainShape shape = make_grain_shape(*body);
    pair.add(shape, shape.origin, shape.turn);
  }
  keep_pair(pair, {"stored_energy", "hertz_mindlin", 1e9}, stem);
}

int fuzz(const FuzzOrder& order) {
  Random random(order.seed);
  long pairs = 0, overlapping = 0;
  int offenders = 0;
  for (; !order.is_done(pairs, offenders); ++pairs) {
    const Polyhedron a = any_body(random);
    const Polyhedron b = moved(random.below(8) ? any_body(random) : a, any_place(random));
    const Found found = judge(a, b, overlapping);
    if (!found.what && pairs != order.keep) continue;
    const std::string stem = order.stem(pairs);
    keep(found, stem);
    if (!found.what) continue;
    ++offenders;
    std::printf("%s: off by %.3g, kept as %s.prm, %s_a.off and _b.off\n", found.what, found.value,
                stem.c_str(), stem.c_str());
  }
  std::printf("seed %llu: %ld pairs, %ld overlapping, %d offenders, %.0f s\n",
              static_cast<unsigned long long>(order.seed), pairs, overlapping, offenders,
              order.elapsed());
  return offenders > 0;
}

}  // namespace
}  // namespace trackbed::dem::test

int main(int argc, char** argv) {
  return trackbed::dem::test::fuzz_as_ordered(argc, argv, "fuzz_pairs", trackbed::dem::test::fuzz);
}
