// fuzz_walk (options: fuzz_order.h): random pairs of bodies of all kinds and laws, one held, the other
// led about it, into contact and out again, over faces, edges and corners, by steps of 1e-5 to a
// tenth of its size. Contacts start each step from what they were in the last one: the nearest
// features, the separating axis, how long a pair that is apart may sleep. After every step all must
// be as if found afresh: which parts touch, force, torque and energy. Left out is where cores of
// dilated bodies overlap, as the way out is the nearest to the last one. An offender is kept as a
// scene, DIR/*.prm, as the bodies stood. Exit 1 if there is one, or if nothing touched.
#include <cmath>
#include <cstdio>

#include "dem/grain/parts.h"
#include "motion_scene.h"
#include "tests/hard/fuzz_grains.h"
#include "tests/hard/fuzz_order.h"
#include "tests/hard/keep_pair.h"

namespace trackbed::dem::test {
namespace {

constexpr double kModulus = 1e9, kStiffness = 1e6;
constexpr double kSame = 1e-6;       // of force, torque, energy
constexpr double kAside = 2e-5;      // sqrt(2 1e-13/crown): balls so far off are as deep [m]
constexpr double kRounding = 1e-12;  // of places, [m]

Polyhedron box_between(const Vec3& low, const Vec3& high) {
  Polyhedron box = make_box(high - low);
  for (Vec3& v : box.vertices) v += (low + high) / 2;
  return box;
}

struct Pair {
  GrainShape a, b;
  std::string law, round;
  double deepest = HUGE_VAL;  ///< the walk turns back there [m]
};

GrainShape any_grain(Random& random, Pair& pair) {
  const double r = random.uniform(.03, .3);
  const auto limit = [&](double depth) { pair.deepest = std::min(pair.deepest, depth); };
  switch (random.below(6)) {
    case 0:
      limit(r / 4);
      return sphere_shape(r);
    case 1: {
      limit(r / 4);
      std::vector<Sphere> spheres{{Vec3::Zero(), r}};
      for (int k = 0; k < 3; ++k)
        spheres.push_back({.5 * random.uniform() * random.direction(), r * random.uniform(.5, 1)});
      return as_grain(make_clump_shape(spheres));
    }
    case 2:
    case 3:
      limit(r / 4);
      return as_grain(make_dilated_shape({any_core(random), r}));
    case 4: {  // an ell of two parts
      limit(.05);
      const double a = random.uniform(.2, .6), b = random.uniform(.2, .6);
      return union_shape({box_between({0, 0, 0}, {1, a, .5}), box_between({0, a, 0}, {b, 1, .5})});
    }
    default:
      limit(.1);
      return make_grain_shape(any_core(random));
  }
}

Pair any_pair(Random& random) {
  static const char* rounds[] = {"hertz_mindlin", "hertz_flat", "sun2015", "linear"};
  Pair p;
  p.a = any_grain(random, p), p.b = any_grain(random, p);
  if (random.below(4) == 0) p.b = make_grain_shape(make_box({4, 4, .5 + random.uniform()}));
  p.law = random.below(4) ? "stored_energy" : "shao2017";
  p.round = rounds[random.below(4)];
  return p;
}

Scene scene_of(const Pair& p) {
  Scene s(kModulus, 0, p.law);
  PairMaterial m = s.materials(0, 0);
  m.stiffness = kStiffness;
  s.materials.set(0, 0, m);
  s.round = make_round_forces(p.round, false);
  s.context.gravity.setZero();
  s.context.dt = 1;
  s.add(p.a, 1, Vec3::Zero());
  s.add(p.b, 1, Vec3::Zero(), Quat::Identity(), kFixed);
  return s;
}

// Against a scene that knows nothing but where the bodies are.
Fault judge(const Scene& s) {
  for (const Vec3& f : {s.bodies.force[0], s.bodies.torque[0], s.bodies.torque[1]})
    if (!f.allFinite()) return {"no finite force", f.norm()};
  Scene t = s;
  t.pairs = Pairs(), t.candidates = Candidates();
  t.prepare();
  const double size = s.shapes.shape(0).radius, force = t.bodies.force[0].norm();
  double depth = HUGE_VAL;
  bool crowned = false;
  for (int p = 0; p < t.pairs.size(); ++p) {
    if (!t.pairs.touching[p]) continue;
    crowned |= t.pairs.kind[p] >= int(PairKind::point_core);
    depth = std::min(depth, t.pairs.depth[p]);
    // Where cores meet, the way out is the nearest to the last one.
    if (t.pairs.kind[p] == int(PairKind::cores) && t.pairs.faces_a[p] == 0) return {};
  }
  if (depth < 1e3 * kRounding) return {};
  if (count_contacts(s.pairs) != count_contacts(t.pairs))
    return {"number of contacts", double(count_contacts(s.pairs) - count_contacts(t.pairs))};
  if (force == 0) return {};
  const double unsure = kSame + kRounding / depth, energy = t.now().normal;
  const double off = (s.bodies.force[0] - t.bodies.force[0]).norm() / force,
               turned = (s.bodies.torque[0] - t.bodies.torque[0]).norm() / (size * force),
               stored = energy > 0 ? std::abs(s.now().normal / energy - 1) : 0;
  if (!(off < unsure)) return {"force", off};
  if (!(turned < unsure + (crowned ? kAside / size : 0))) return {"torque", turned};
  if (!(stored < unsure)) return {"energy", stored};
  return {};
}

double deepest(const Scene& s) {
  double most = 0;
  for (int p = 0; p < s.pairs.size(); ++p)
    if (s.pairs.touching[p]) most = std::max(most, s.pairs.depth[p]);
  return most;
}

// Legs of some steps each: towards the other body, along it or away, turning. Too deep it turns back.
Fault walk(Random& random, const Pair& pair, Scene& s, long& touching) {
  Bodies& b = s.bodies;
  test::place(b, 1, Vec3::Zero(), random_rotation(random));
  test::place(b, 0, (pair.a.radius + pair.b.radius) * random.direction(), random_rotation(random));
  s.prepare();
  for (int leg = 0; leg < 40; ++leg) {
    const double stride = pair.a.radius * std::pow(10., random.uniform(-5, -1));
    const Vec3 in = (b.x[1] - b.x[0]).normalized();
    const bool back = deepest(s) > pair.deepest, near = deepest(s) > 0;
    b.v[0] =
        stride * (back ? Vec3(-in)
                       : Vec3((near ? random.uniform(-.3, .5) : 1) * in + .7 * random.direction()));
    set_spin(b, 0, random.uniform(0, 2) * stride / pair.a.radius * random.direction());
    for (int k = 0; k < 12; ++k) {
      b.force[0].setZero(), b.torque[0].setZero();  // it is led
      drift(b, s.context);
      s.candidates.update(b, s.shapes, s.context, s.pairs);
      s.evaluate(s.context.dt);
      touching += count_contacts(s.pairs) > 0;
      if (const Fault f = judge(s); f.what) return f;
      if (!back && deepest(s) > pair.deepest) break;
    }
  }
  return {};
}

int fuzz(const FuzzOrder& order) {
  Random random(order.seed);
  long pairs = 0, touching = 0;
  int offenders = 0;
  for (; !order.is_done(pairs, offenders); ++pairs) {
    const Pair pair = any_pair(random);
    Scene s = scene_of(pair);
    const Fault fault = walk(random, pair, s, touching);
    if (!fault.what && pairs != order.keep) continue;
    PackedGrains both;
    for (int i = 0; i < 2; ++i) both.add(i == 0 ? pair.a : pair.b, s.bodies.x[i], s.bodies.q[i]);
    keep_pair(both, {pair.law, pair.round, kModulus, kStiffness}, order.stem(pairs));
    if (!fault.what) continue;
    ++offenders;
    std::printf("pair %ld, %s, %s, kind %d, %.3g m deep: %s off by %.3g, kept as %s.prm\n", pairs,
                pair.law.c_str(), pair.round.c_str(), s.pairs.size() ? int(s.pairs.kind[0]) : -1,
                deepest(s), fault.what, fault.value, order.stem(pairs).c_str());
  }
  std::printf("seed %llu: %ld pairs, %ld steps in contact, %d offenders, %.0f s\n",
              static_cast<unsigned long long>(order.seed), pairs, touching, offenders,
              order.elapsed());
  return offenders > 0 || touching == 0;
}

}  // namespace
}  // namespace trackbed::dem::test

int main(int argc, char** argv) {
  return trackbed::dem::test::fuzz_as_ordered(argc, argv, "fuzz_walk", trackbed::dem::test::fuzz);
}
