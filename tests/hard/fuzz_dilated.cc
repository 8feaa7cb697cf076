// fuzz_dilated (options: fuzz_order.h): random pairs of dilated polyhedra, a plain one now and then,
// laid vertex, edge or face on vertex, edge or face, parallel but for 1e-14 to 0.1, shifted by
// lattice steps or nothing. Each is judged
//   - by duality: |y - x| - r_a - r_b is convex, so that its slopes at the balls found and the
//     vertices of both cores bound how much deeper any two balls can be;
//   - flat faces: the overlap of the prism pair that is largest against CGAL's exact arithmetic,
//     and the sum against that of all faces of both;
//   - by symmetry of the two bodies, and by force and torque as gradients of the energy.
// An offender is kept as a scene, DIR/*.prm, which `trackbed run` replays. Exit 1 if there is one.
#include <cmath>
#include <cstdio>

#include "dem/contact/face_prism.h"
#include "dem/contact/flat_contact.h"
#include "tests/hard/fuzz_grains.h"
#include "tests/hard/fuzz_order.h"
#include "tests/hard/keep_pair.h"

namespace trackbed::dem::test {
namespace {

constexpr double kModulus = 1e9;
constexpr double kDeeper = 1e-11;   // of the cores' size
constexpr double kVolume = 1e-9;    // relative
constexpr double kSymmetry = 1e-9;  // of energy and force
constexpr double kGradient = 1e-3;  // of the force

Scene pair_of(const GrainShape& a, const GrainShape& b, const char* law) {
  Scene s(kModulus, 0);
  s.round = make_round_forces(law, false);
  s.context.gravity.setZero();
  s.add(a, 1, Vec3::Zero()), s.add(b, 1, Vec3::Zero());
  return s;
}

void place(Scene& s, int i, const Vec3& x, const Mat3& R) { test::place(s.bodies, i, x, R); }

double energy(Scene& s) {
  std::fill(s.pairs.wake.begin(), s.pairs.wake.end(), 0.0);
  s.prepare();
  return s.now().normal;
}

const PartView& part(const Scene& s, int i) {
  const int shape = s.bodies.shape[i];
  return s.round.flat_faces ? s.shapes.flat_part(shape, 0) : s.shapes.part(shape, 0);
}

DeepestBalls balls_of(const Scene& s, int i, int j) {
  Vec3 axis = s.bodies.x[j] - s.bodies.x[i];
  return deepest_balls(part(s, i), s.bodies.R[i], part(s, j),
                       {s.bodies.R[j], s.bodies.x[j] - s.bodies.x[i]}, Vec3::Zero(), axis);
}

// b on a by chosen features of both, a share of the radii deep.
void lay(Scene& s, Random& random) {
  const Mat3 Ra = random.below(3) ? random_rotation(random) : Mat3(Mat3::Identity());
  const Vec3 out = Ra * any_direction(random, part(s, 0).core),
             own = any_direction(random, part(s, 1).core);
  const double spin = random.below(2) ? random.below(8) * M_PI / 4 : random.uniform(0, 6);
  const Mat3 Rb = rotation(any_tilt(random) * random.direction()) * rotation(spin * out) *
                  Quat::FromTwoVectors(own, -out).toRotationMatrix();
  const Vec3 aside = random.below(3) == 0 ? Vec3(Vec3::Zero())
                     : random.below(2)    ? Vec3(.125 * random.below(9) * out.unitOrthogonal())
                                          : Vec3(random.uniform(0, .8) * random.direction());
  const Vec3 across = aside - out.dot(aside) * out;
  const double depth =
      (part(s, 0).radius + part(s, 1).radius) * std::pow(10., random.uniform(-5, -.8));
  place(s, 0, Vec3::Zero(), Ra);
  double near = 0, far = 8;
  for (int k = 0; k < 50; ++k) {
    const double middle = (near + far) / 2;
    place(s, 1, middle * out + across, Rb);
    (balls_of(s, 0, 1).overlap > depth ? near : far) = middle;
  }
  place(s, 1, far * out + across, Rb);
}

// How much deeper than those found any two balls may be, at most [m]; or how far the balls
// themselves are from what they should be.
double can_be_deeper(const Scene& s, const DeepestBalls& d) {
  const PartView &a = part(s, 0), &b = part(s, 1);
  const Vec3 x = s.bodies.R[0].transpose() * d.x,
             y = s.bodies.R[1].transpose() * (d.y - s.bodies.x[1]), way = d.y - d.x;
  const double distance = way.norm();
  const auto slack = [](const PartView& p, const Vec3& at, const Vec3& slope, double r) {
    const double radius = p.radius + p.crown / 2 * (p.mean_square - at.squaredNorm());
    double off = std::abs(radius - r), least = 0;
    for (int f = 0; f < p.core.faces; ++f)
      off = std::max(off, p.core.nx[f] * at.x() + p.core.ny[f] * at.y() + p.core.nz[f] * at.z() -
                              p.core.offset[f]);
    for (int v = 0; v < p.core.vertices; ++v)
      least = std::min(least, slope.dot(Vec3(p.core.x[v], p.core.y[v], p.core.z[v]) - at));
    return off - least;
  };
  const Vec3 n = way / distance;
  return slack(a, x, a.crown * x - s.bodies.R[0].transpose() * n, d.ra) +
         slack(b, y, b.crown * y + s.bodies.R[1].transpose() * n, d.rb) +
         std::abs(d.ra + d.rb - distance - d.overlap);
}

Fault judge_flats(const Scene& s, const DeepestBalls& d, long& flats) {
  const PartView &a = part(s, 0), &b = part(s, 1);
  const Pose own{s.bodies.R[0], Vec3::Zero()}, pose{s.bodies.R[1], s.bodies.x[1]};
  OverlapWorkspace work;
  NormalContact c;
  const double found =
      flat_contact(a, own.R, b, pose, d, material(kModulus), work, c) ? c.shape.volume : 0;
  double sum = 0, surface = 0;  // of all prism pairs
  double largest = 0, largest_surface = 0, exact = 0;
  const auto each = [](const PartView& p, auto&& visit) {
    FacePrism prism;
    if (p.radius == 0) return visit(p.core);
    for (int f = 0; f < p.core.faces; ++f)
      for (int k = 0; k < prisms_of(p.core, f); ++k)
        make_face_prism(p.core, f, k, p.radius, prism), visit(prism.view);
  };
  each(a, [&](const ConvexView& u) {
    each(b, [&](const ConvexView& v) {
      OverlapMoments m;
      work.clear();
      const ContactFrame frame = contact_frame(u, own, v, pose, d.n);
      if (!overlap(u, own, v, pose, frame, work, m)) return;
      double own_surface = 0;
      for (const auto* pieces : {&work.a_pieces, &work.b_pieces})
        for (const OverlapPiece& piece : *pieces) own_surface += piece.area.norm();
      sum += m.volume, surface += own_surface;
      if (m.volume < largest) return;
      std::vector<Plane> all = planes_of(u, own.R, own.x), more = planes_of(v, pose.R, pose.x);
      all.insert(all.end(), more.begin(), more.end());
      const Exact e = exact_overlap(all, frame.origin + frame.axes * make_shape(m, work).centroid);
      largest = m.volume, largest_surface = own_surface, exact = e.volume;
    });
  });
  // Each plane and corner is known to some roundings of the bodies' size, delta. A plane that
  // moves by delta changes the volume by delta times the area of its piece, so that no volume is
  // known better than to delta S, S the overlap's surface: where flat parts meet by little not only
  // the depth is small but, at an edge or between walls, its width as well, and S/V is larger than
  // 1/depth.
  const double delta = 2e-15 * (a.core.radius + b.core.radius);
  if (sum < 1e-15 && found < 1e-15) return {};
  ++flats;
  if (!(std::abs(largest - exact) < kVolume * exact + delta * largest_surface))
    return {"largest flat overlap against exact arithmetic", largest / exact - 1};
  if (!(std::abs(found - sum) < 2 * (kVolume * sum + delta * surface) + 1e-16))
    return {"flat overlaps against those of all faces", found / sum - 1};
  return {};
}

// Force and torque on body 1 along axis k against the one-sided differences of the energy, which
// differ where walls of both bodies coincide.
Fault judge_gradient(Scene& s, double step) {
  const double stored = energy(s);
  if (!(s.pairs.size() == 1 && s.pairs.touching[0])) return {"no contact", 0};
  const Vec3 force = s.bodies.force[1], torque = s.bodies.torque[1], x = s.bodies.x[1];
  const Mat3 R = s.bodies.R[1];
  const double size = part(s, 1).core.radius;
  for (int k = 0; k < 6; ++k) {
    const Vec3 e = step * Vec3::Unit(k % 3);
    const auto slope = [&](double sign) {
      if (k < 3)
        place(s, 1, x + sign * e, R);
      else
        place(s, 1, x, rotation(sign / size * e) * R);
      return sign * (stored - energy(s)) / (k < 3 ? step : step / size);
    };
    const double up = slope(1), down = slope(-1), given = k < 3 ? force[k] : torque[k - 3];
    const double scale = k < 3 ? force.norm() : size * force.norm();
    const double off =
        std::max({0., std::min(up, down) - given, given - std::max(up, down)}) / scale;
    place(s, 1, x, R);
    if (!(off < kGradient))
      return {k < 3 ? "force as the energy's gradient" : "torque as the energy's gradient", off};
  }
  return {};
}

Fault judge(Scene& s, const char* law, long& flats, long& deep) {
  const DeepestBalls d = balls_of(s, 0, 1);
  if (!(d.overlap > 0)) return {};  // laid beside each other
  const double size = part(s, 0).core.radius + part(s, 1).core.radius;
  const double radii = part(s, 0).radius + part(s, 1).radius;
  if ((d.y - d.x).dot(d.n) < 1e-3 * radii) return ++deep, Fault{};  // the cores touch
  const double deeper = can_be_deeper(s, d);
  if (!(deeper < kDeeper * size)) return {"other balls may be deeper", deeper / size};
  if (s.round.flat_faces)
    if (const Fault f = judge_flats(s, d, flats); f.what) return f;
  const double stored = energy(s);
  const Vec3 force = s.bodies.force[1],
             moment = s.bodies.torque[0] + s.bodies.torque[1] + s.bodies.x[1].cross(force);
  const double rest = std::max((s.bodies.force[0] + force).norm(), moment.norm() / size);
  if (!(rest < kSymmetry * force.norm())) return {"forces of the two bodies", rest / force.norm()};
  Scene t = pair_of(s.shapes.shape(s.bodies.shape[1]), s.shapes.shape(s.bodies.shape[0]), law);
  place(t, 0, s.bodies.x[1], s.bodies.R[1]), place(t, 1, s.bodies.x[0], s.bodies.R[0]);
  const double other = energy(t), unsure = kSymmetry + 1e-13 * size / d.overlap;
  if (!(std::abs(other - stored) < unsure * stored))
    return {"energy with the bodies exchanged", other / stored - 1};
  return judge_gradient(s, 1e-4 * d.overlap);
}

void keep(const Scene& s, const char* law, const std::string& stem) {
  PackedGrains pair;
  for (int i = 0; i < 2; ++i)
    pair.add(s.shapes.shape(s.bodies.shape[i]), s.bodies.x[i], s.bodies.q[i]);
  keep_pair(pair, {"stored_energy", law, kModulus}, stem);
}

int fuzz(const FuzzOrder& order) {
  Random random(order.seed);
  const auto dilated = [&] {
    return as_grain(make_dilated_shape({any_core(random), random.uniform(.03, .3)}));
  };
  long pairs = 0, flats = 0, deep = 0;
  int offenders = 0;
  for (; !order.is_done(pairs, offenders); ++pairs) {
    const char* law = random.below(3) ? "hertz_flat" : "hertz_mindlin";
    const GrainShape a = dilated();
    const GrainShape b = random.below(5) == 0   ? make_grain_shape(any_core(random))
                         : random.below(8) == 0 ? a
                                                : dilated();
    Scene s = pair_of(a, b, law);
    lay(s, random);
    const Vec3 x = s.bodies.x[1];
    const Mat3 R = s.bodies.R[1];
    const Fault fault = judge(s, law, flats, deep);
    if (!fault.what && pairs != order.keep) continue;
    place(s, 1, x, R);
    const std::string stem = order.stem(pairs);
    keep(s, law, stem);
    if (!fault.what) continue;
    ++offenders;
    std::printf("%s, %s: off by %.3g, kept as %s.prm\n", law, fault.what, fault.value,
                stem.c_str());
  }
  std::printf(
      "seed %llu: %ld pairs, %ld with flat parts, %ld with cores that touch, %d offenders, "
      "%.0f s\n",
      static_cast<unsigned long long>(order.seed), pairs, flats, deep, offenders, order.elapsed());
  return offenders > 0;
}

}  // namespace
}  // namespace trackbed::dem::test

int main(int argc, char** argv) {
  return trackbed::dem::test::fuzz_as_ordered(argc, argv, "fuzz_dilated",
                                              trackbed::dem::test::fuzz);
}
