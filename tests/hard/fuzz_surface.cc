// fuzz_surface (options: fuzz_order.h; a grain and a surface are a pair): random grains - plain
// polyhedra, dilated ones with crowned or flat faces, spheres, clumps - laid by a vertex, an edge or
// a face, parallel but for 1e-14 to 0.1, on a facet, a mesh edge or a node of a random mesh, flat or
// bent, 1e-5 m up to half of themselves deep (they are about 1 m wide). Each is judged
//   - by balance: the nodal forces' sum and moment are minus those on the grain;
//   - by force, torque and nodal forces as gradients of the stored energy;
//   - on flat ones, however they are meshed, wherever they end in a skirt or at a seam: force, torque
//     and energy are those on one quad and those on a held block (the kernels of pairs), and of plain
//     grains those of the exact overlap;
//   - dragged along with friction and damping, the surface in motion too: by balance, Coulomb's
//     bound, the normal forces of contacts found afresh and, on flat surfaces, the same drag over one
//     quad.
// The law shao2017 stores no energy and has no gradient; on bent surfaces it is judged by balance
// alone. An offender on a flat surface is kept as a scene, DIR/*.prm, with the block in place of the
// surface, which `trackbed run` replays; one on a bent surface is but named. Exit 1 if there is one.
#include <cmath>
#include <cstdio>
#include <numeric>

#include "tests/hard/fuzz_drag.h"
#include "tests/hard/fuzz_laid.h"
#include "tests/hard/fuzz_order.h"
#include "tests/hard/fuzz_section.h"
#include "tests/hard/keep_pair.h"

namespace trackbed::dem::test {
namespace {

constexpr double kBalance = 1e-13;         // of the sum of the nodal forces' sizes
constexpr double kDraggedBalance = 1e-11;  // of long thin overlaps friction's shares round
constexpr double kSame = 1e-9;             // of force, torque and energy
constexpr double kRounding = 2e-13;        // of places, [m]: where planes meet at small angles
constexpr double kMoments = 2e-15;         // of second moments, of the largest
constexpr double kDeeper = 1e-13;          // how much deeper other balls may be, [m]
constexpr double kNormals = 3e-8;          // sine between normals whose cosines round to the same
constexpr double kDragged = 4;             // times as unsure is what has a past
constexpr double kStep = 1e-3;             // of differences, of the depth
constexpr double kGradient = 1e-3;         // of the force

Pose block_under(const Case& c, double edge) {
  const Ground& g = c.ground;
  const Vec3 level = g.R.transpose() * (c.x - g.x);
  return {g.R, g.x + g.R * Vec3(level.x(), level.y(), -edge / 2)};
}

Answer on_block(const Case& c) {
  Scene s(kModulus, 0, c.plain ? c.law : "stored_energy");
  if (!c.plain) s.round = make_round_forces(c.law, false);
  set_stiffness(s.materials);
  s.context.gravity.setZero();
  s.add(c.grain, 1, Vec3::Zero());
  place(s.bodies, 0, c.x, c.R);
  const double edge = 6 * c.grain.radius;
  const Pose pose = block_under(c, edge);
  add_rigid_body(s.bodies, s.shapes, make_box(Vec3::Constant(edge)), 0, 1, pose.x, Quat(pose.R),
                 kFixed);
  s.prepare();
  return {s.bodies.force[0], s.bodies.torque[0], s.now().normal};
}

Ground one_quad(const Case& c) {
  Ground g = c.ground;
  g.period.setZero(), g.skirt = 0;
  g.mesh = flat_mesh(1, 1, -16, 16, -16, 16);
  for (Vec3& p : g.mesh.nodes) p = g.R * p + g.x;
  return g;
}

// How well an answer is known, relative; the torque by the force and the grain's radius.
//
// Places round. Second moments of a long thin overlap round as the largest of them does, and the
// law reads the smallest: of what lies on a flat surface, whose frame is level, by its width over
// its length; where the frame may be a tilted face's, of a pair's flat parts and on bent surfaces,
// by its depth over its length. The deepest balls of crowned faces lie anywhere where others are not
// deeper by more than rounding. A pair's frame (shao2017's force and depth are along it) takes the
// normal of either of two faces that cannot be told apart.
struct Unsure {
  double force = kSame, torque = kSame, energy = kSame;

  Unsure(const Case& c, const PartView& part, const Section& section, bool pair) {
    const double size = c.grain.radius;
    double all = kRounding / c.depth;
    if (c.plain || (c.law == "hertz_flat" && part.kind != Core::point)) {
      const bool tilted = c.ground.bent || (pair && !c.plain);
      all += kMoments * (tilted ? size * size / (c.depth * c.depth) : section.slender);
    }
    if (part.crown > 0) {
      const double aside = std::sqrt(2 * kDeeper / part.crown);
      force += part.crown * aside / part.radius, torque += aside / size;
      all += 2.5 * kDeeper / c.depth;
    }
    if (pair && !c.stores) force += kNormals * (1 + size / c.depth);
    force += all, torque += all + (pair && !c.stores ? force : 0), energy += all;
  }

  friend Unsure operator*(double times, Unsure u) {
    u.force *= times, u.torque *= times, u.energy *= times;
    return u;
  }
};

Fault compare(const Case& c, const Answer& a, const Answer& b, const Unsure& u, const char* what) {
  const double force = (a.force - b.force).norm() / b.force.norm(),
               torque = (a.torque - b.torque).norm() / (c.grain.radius * b.force.norm()),
               energy = b.energy > 0 ? std::abs(a.energy / b.energy - 1) : std::abs(a.energy);
  const bool same = force < u.force && torque < u.torque && energy < u.energy;
  return same ? Fault{} : Fault{what, std::max({force, torque, energy})};
}

Fault judge_balance(const PatchScene& s, double tolerance = kBalance) {
  Vec3 sum = s.bodies.force[0], moment = s.bodies.torque[0];
  double size = 0, arms = 0;
  for (const auto& nodal : s.contacts.nodal)
    for (const auto& [node, f] : nodal) {
      const Vec3 arm = s.patch.node[node] - s.bodies.x[0];
      moment += arm.cross(f), size += f.norm(), arms += arm.norm() * f.norm();
    }
  sum += s.nodal_sum();
  if (size == 0) return {};  // it does not touch
  if (!(sum.norm() < tolerance * size)) return {"sum of the nodal forces", sum.norm() / size};
  if (s.context.period == Vec3::Zero() && !(moment.norm() < tolerance * arms))
    return {"moment of the nodal forces", moment.norm() / arms};
  return {};
}

Fault judge_flat(const Case& c, const OnGround& s, const OnLevel& level, const Answer& found) {
  const Section section(cross_section(level));
  const Unsure unsure(c, s.part(), section, false);
  if (const Fault f =
          compare(c, found, OnGround(c, one_quad(c)).answer(c.x, c.R), unsure, "against one quad");
      f.what)
    return f;
  const Unsure of_pair(c, s.part(), section, true);
  if (const Fault f = compare(c, found, on_block(c), of_pair, "against a held block"); f.what)
    return f;
  if (!c.plain) return {};
  ExactAnswer exact;
  const Vec3 point = c.ground.R.transpose() * (s.contacts.point[0] - c.ground.x);
  if (!answer_exactly(level, point, kModulus, exact))
    return {"the contact's point is not inside of both", c.depth};
  const double off = c.stores ? std::abs(found.energy / exact.energy - 1)
                              : std::abs(found.force.norm() / exact.force - 1);
  if (!(off < unsure.energy)) return {"against exact arithmetic", off};
  return {};
}

// What is given as the slope of the stored energy along a motion, against the one-sided
// differences, which differ where the energy has a kink.
template <class Move>
double off_slope(OnGround& s, double stored, double given, double step, Move&& move) {
  const auto slope = [&](double sign) {
    move(sign * step);
    s.evaluate_afresh();
    return sign * (stored - s.energy()) / step;
  };
  const double up = slope(1), down = slope(-1);
  move(0);
  return std::max({0., std::min(up, down) - given, given - std::max(up, down)});
}

Fault judge_gradient(const Case& c, OnGround& s, const Answer& found, double unsure) {
  const double force = found.force.norm(), size = c.grain.radius, step = kStep * c.depth;
  const double most = (kGradient + unsure / kStep) * force;
  const std::vector<Vec3> on_node = s.patch.force;
  for (int k = 0; k < 3; ++k) {
    const Vec3 e = Vec3::Unit(k);
    const double off = off_slope(s, found.energy, found.force[k], step,
                                 [&](double way) { place(s.bodies, 0, c.x + way * e, c.R); });
    if (!(off < most)) return {"force as the energy's gradient", off / force};
    const double turned = off_slope(s, found.energy, found.torque[k] / size, step, [&](double way) {
      place(s.bodies, 0, c.x, rotation(way / size * e) * c.R);
    });
    if (!(turned < most)) return {"torque as the energy's gradient", turned / force};
  }
  place(s.bodies, 0, c.x, c.R);
  if (c.ground.period != Vec3::Zero()) return {};  // the surface would part at the seam
  Random random(1);
  for (int i = 0; i < s.patch.carried; ++i) {
    if (on_node[i].norm() < 1e-2 * force) continue;
    const Vec3 p = s.patch.node[i], e = random.direction();
    const double off = off_slope(s, found.energy, on_node[i].dot(e), step, [&](double way) {
      s.patch.node[i] = p + way * e;
      move_skirt(s.patch);
    });
    if (!(off < most)) return {"nodal force as the energy's gradient", off / force};
  }
  return {};
}

// The springs of the contacts' normals are those of contacts without a past.
Fault judge_normals(const Dragged& s, const Unsure& unsure) {
  OnGround t = s;
  t.evaluate_afresh();
  const auto sum = [](const std::vector<Vec3>& v) {
    return std::accumulate(v.begin(), v.end(), Vec3(Vec3::Zero()));
  };
  const Vec3 force = sum(t.contacts.normal_force);
  const double stored = t.energy(), more = std::abs(s.energy() - stored),
               off = (sum(s.contacts.normal_force) - force).norm();
  if (!(more <= unsure.energy * stored)) return {"dragged, against afresh: energy", more / stored};
  if (s.materials(0, 0).damping == 0 && !(off <= unsure.force * force.norm()))
    return {"dragged, against afresh: force", off / force.norm()};
  return {};
}

// With friction and damping, step by step: balance, Coulomb's bound, the normal forces of contacts
// without a past and, on flat surfaces, what one quad answers to the same drag.
Fault judge_drag(const Case& c, const Drag& d) {
  Dragged s(c, c.ground, d), plain(c, c.ground.bent ? c.ground : one_quad(c), d);
  const double start = s.bodies.force[0].norm();
  Random jolts(1);
  Vec3 level = c.ground.x;
  for (int k = 0; k < Drag::kSteps; ++k) {
    const Answer found = s.step(d, k, jolts);
    if (const Fault f = judge_balance(s, kDraggedBalance); f.what) return f;
    for (int i = 0; i < s.contacts.size(); ++i) {
      const double most = d.friction * s.contacts.normal_force[i].norm(),
                   size = s.contacts.friction[i].norm();
      if (!(size <= most * (1 + 1e-12))) return {"friction beyond Coulomb's", size / most - 1};
    }
    level += d.ground[k];
    const Answer same = c.ground.bent ? found : plain.step(d, k, jolts);
    if (!(same.force.norm() > .01 * start)) continue;  // it comes off: less deep than it was laid
    if (c.ground.bent) {
      const Unsure unsure(c, s.part(), Section({}), false);
      if (const Fault f = judge_normals(s, kDragged * unsure); f.what) return f;
      continue;
    }
    const Mat3 down = c.ground.R.transpose();
    const OnLevel there{s.part(), down * s.bodies.R[0], down * (s.bodies.x[0] - level)};
    const Unsure unsure(c, s.part(), Section(cross_section(there)), false);
    if (const Fault f = compare(c, found, same, kDragged * unsure, "dragged, against one quad");
        f.what)
      return f;
    if (const Fault f = judge_normals(s, kDragged * unsure); f.what) return f;
  }
  return {};
}

Fault judge(const Case& c) {
  OnGround s(c, c.ground);
  const Answer found = s.answer(c.x, c.R);
  if (count_contacts(s.contacts) == 0) return {"no contact", c.depth};
  if (const Fault f = judge_balance(s); f.what) return f;
  // A level through the contact where the surface has none.
  Mat3 R = c.ground.R;
  Vec3 at = c.ground.x;
  if (c.ground.bent) {
    R = Quat::FromTwoVectors(Vec3::UnitZ(), found.force).toRotationMatrix();
    at = s.contacts.point[0];
  }
  const OnLevel level{s.part(), R.transpose() * c.R, R.transpose() * (c.x - at)};
  if (!c.ground.bent)
    if (const Fault f = judge_flat(c, s, level, found); f.what) return f;
  if (!c.stores) return {};
  const Unsure unsure(c, s.part(), Section(cross_section(level)), false);
  return judge_gradient(c, s, found, unsure.energy);
}

// Both let go, so that gravity takes them along together.
void keep(const Case& c, const std::string& stem) {
  const double edge = 4 * c.grain.radius;
  const GrainShape box = make_grain_shape(make_box(Vec3::Constant(edge)));
  const Pose pose = block_under(c, edge);
  PackedGrains pair;
  pair.add(c.grain, c.x, Quat(c.R));
  pair.add(box, pose.x, Quat(pose.R) * box.turn);
  PairLaw law{c.plain ? c.law : "stored_energy", c.plain ? "hertz_mindlin" : c.law, kModulus};
  law.stiffness = kStiffness;
  keep_pair(pair, law, stem);
}

int fuzz(const FuzzOrder& order) {
  Random random(order.seed);
  long pairs = 0, bent = 0;
  int offenders = 0;
  for (; !order.is_done(pairs, offenders); ++pairs) {
    Case c;
    draw_grain(random, c);
    c.ground = any_ground(random, 2 * c.grain.radius);
    lay(random, c);
    bent += c.ground.bent != nullptr;
    Fault fault;
    try {
      fault = judge(c);
      if (!fault.what) fault = judge_drag(c, any_drag(random, c));
    } catch (const RunError&) {
      fault = {"refused as too deep", c.depth};
    }
    if (!fault.what && pairs != order.keep) continue;
    const std::string stem = order.stem(pairs);
    if (!c.ground.bent) keep(c, stem);
    if (!fault.what) continue;
    ++offenders;
    std::printf("pair %ld, %s on %zu quads%s%s%s, %.3g m deep: %s: off by %.3g%s%s%s\n", pairs,
                c.law.c_str(), c.ground.mesh.quads.size(), c.ground.bent ? ", " : "",
                c.ground.bent ? c.ground.bent : "",
                c.ground.period.x() > 0 ? ", seam" : (c.ground.skirt > 0 ? ", skirt" : ""), c.depth,
                fault.what, fault.value, c.ground.bent ? "" : ", kept as ",
                c.ground.bent ? "" : stem.c_str(), c.ground.bent ? "" : ".prm");
  }
  std::printf("seed %llu: %ld pairs, %ld on bent surfaces, %d offenders, %.0f s\n",
              static_cast<unsigned long long>(order.seed), pairs, bent, offenders, order.elapsed());
  return offenders > 0;
}

}  // namespace
}  // namespace trackbed::dem::test

int main(int argc, char** argv) {
  return trackbed::dem::test::fuzz_as_ordered(argc, argv, "fuzz_surface",
                                              trackbed::dem::test::fuzz);
}
