// An effect that is off equals the simpler model and is not called: motion, contact, coupling.
// (Friction off against a coefficient of zero: motion_impacts_test.)
#include <gtest/gtest.h>

#include "coupling_scene.h"
#include "motion_scene.h"

namespace trackbed {
namespace {

using dem::Vec3;

dem::Scene tumbling_blocks() {
  dem::Scene s(1e8, .5);
  for (int k = 0; k < 4; ++k)
    s.add_block({.1, .07, .05}, 2600, {.02 * k, .01 * k, .08 + .11 * k},
                dem::turn_about({1, 2., .5}, .9 * k));
  s.add_floor(1, .2);
  for (int k = 0; k < 4; ++k) s.bodies.v[k] = {0, 0, -2. - k};  // those above are faster
  s.context.dt = 2e-5;
  return s;
}

void expect_same_bits(const dem::Bodies& a, const dem::Bodies& b) {
  for (int i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a.x[i], b.x[i]) << i;
    EXPECT_EQ(a.v[i], b.v[i]) << i;
    EXPECT_EQ(a.L[i], b.L[i]) << i;
    EXPECT_EQ(a.q[i].coeffs(), b.q[i].coeffs()) << i;
  }
}

// Steps with a contact, so that a test of nothing is seen.
int run_both(dem::Scene& off, dem::Scene& on) {
  int touching = 0;
  for (int k = 0; k < 4000; ++k) {
    off.step(), on.step();
    touching += dem::count_contacts(off.pairs) > 0;
  }
  return touching;
}

// On with a share that no digit sees: the damped instance does the same arithmetic besides.
TEST(EffectsOff, local_damping_is_the_limit_of_none) {
  dem::Scene off = tumbling_blocks(), on = tumbling_blocks();
  on.context.local_damping = 1e-200;
  off.prepare(), on.prepare();
  EXPECT_GT(run_both(off, on), 100);
  expect_same_bits(off.bodies, on.bodies);
  EXPECT_EQ(off.flow.local_damping, 0);
}

// On with a share that no digit sees: the couples of a pass that is not made when off.
TEST(EffectsOff, torsion_and_rolling_are_the_limit_of_none) {
  for (const bool rolls : {false, true}) {
    dem::Scene none = tumbling_blocks(), on = tumbling_blocks();
    on.resistance.torsion = rolls ? 0 : 1e-200;
    on.resistance.rolling = rolls ? 1e-200 : 0;
    none.prepare(), on.prepare();
    EXPECT_GT(run_both(none, on), 100);
    expect_same_bits(none.bodies, on.bodies);
    EXPECT_TRUE(none.pairs.torsion.empty());
    EXPECT_FALSE(none.pairs.resists);
    EXPECT_TRUE(on.pairs.resists);
  }
}

// On with no rate: the pass multiplies by one. Off: it has never been made.
TEST(EffectsOff, adaptive_damping_is_not_called) {
  dem::Scene off = tumbling_blocks(), on = tumbling_blocks();
  on.adaptive = true, on.adaptive_damping.alpha = 0;
  off.prepare(), on.prepare();
  EXPECT_GT(run_both(off, on), 100);
  expect_same_bits(off.bodies, on.bodies);
  EXPECT_LT(off.adaptive_damping.kinetic, 0);
  EXPECT_GT(on.adaptive_damping.kinetic, 0);
}

// A seam so far away that nothing meets it.
TEST(EffectsOff, periodic_images_are_none_without_a_seam) {
  dem::Scene off = tumbling_blocks(), on = tumbling_blocks();
  on.context.period = {0, 1 << 20, 0};
  off.prepare(), on.prepare();
  EXPECT_GT(run_both(off, on), 100);
  EXPECT_EQ(off.pairs.size(), on.pairs.size());
  expect_same_bits(off.bodies, on.bodies);
}

int pair_calls = 0, patch_calls = 0, round_calls = 0;
dem::PairForces::Evaluate pair_inner = nullptr;
dem::EvaluatePatch patch_inner = nullptr;

void count_calls(coupling::World& w) {
  pair_calls = patch_calls = round_calls = 0;
  pair_inner = w.pair_forces.evaluate;
  patch_inner = w.patch_forces;
  w.pair_forces.evaluate = [](const dem::Bodies& b, const dem::ShapeTable& s,
                              const dem::PairMaterials& m, const dem::StepContext& c,
                              const std::vector<double>& travel, dem::Pairs& p) {
    ++pair_calls;
    pair_inner(b, s, m, c, travel, p);
  };
  w.round_forces.evaluate = [](const dem::Bodies&, const dem::ShapeTable&,
                               const dem::PairMaterials&, const dem::StepContext&,
                               const std::vector<double>&, dem::Pairs&) { ++round_calls; };
  w.patch_forces = [](const dem::Bodies& b, const dem::ShapeTable& s, const dem::PairMaterials& m,
                      const dem::StepContext& c, const std::vector<double>& travel,
                      const dem::SurfacePatch& patch, dem::PatchContacts& contacts) {
    ++patch_calls;
    patch_inner(b, s, m, c, travel, patch, contacts);
  };
}

// The coupled loop on rigid ground: the plain loop of grains, bit by bit, and no call of what
// deforming surfaces need. With one surface: one call of it a step.
TEST(EffectsOff, rigid_ground_never_touches_structures) {
  dem::Scene plain = tumbling_blocks();
  coupling::World w;
  coupling::set_materials(w, 1e8, .5);
  w.shapes = plain.shapes, w.bodies = plain.bodies;
  const dem::StepContext c = coupling::context(plain.context.dt, plain.context.gravity);
  plain.prepare();
  coupling::start(w, c);
  count_calls(w);
  const int steps = 4000;
  int touching = 0;
  for (int k = 0; k < steps; ++k) {
    plain.step();
    touching += dem::count_contacts(plain.pairs) > 0;
  }
  coupling::run(w, c, steps);
  EXPECT_GT(touching, 100);
  expect_same_bits(plain.bodies, w.bodies);
  EXPECT_EQ(pair_calls, steps);
  EXPECT_EQ(patch_calls, 0);
  EXPECT_EQ(round_calls, 0);  // all grains are plain polyhedra
  EXPECT_TRUE(w.surfaces.empty());

  coupling::World bed = coupling::bed(2, 1);
  coupling::start(bed, coupling::context(1e-5, {0, 0, -9.81}));
  count_calls(bed);
  coupling::run(bed, coupling::context(1e-5, {0, 0, -9.81}), 10);
  EXPECT_EQ(pair_calls, 10);
  EXPECT_EQ(patch_calls, 10);
  EXPECT_EQ(bed.times.iterations, 0);  // of an exchange that is not iterated
}

}  // namespace
}  // namespace trackbed
