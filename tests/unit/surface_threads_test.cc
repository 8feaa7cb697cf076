// Grains of each kind on a deforming surface: the same bits whatever the number of threads, and the
// first of the grains that went through is the one that is named.
#include <gtest/gtest.h>

#include "base/error.h"
#include "dem/grain/parts.h"
#include "dem/surface/round_patch.h"
#include "surface_scene.h"

namespace trackbed::dem {
namespace {

constexpr int kRow = 9;
constexpr double kPitch = .2;

GrainShape shape(const std::string& kind) {
  if (kind == "sphere") return sphere_shape(.1);
  if (kind == "dilated") return as_grain(make_dilated_shape({make_box({.1, .08, .06}), .03}));
  return make_grain_shape(make_box({.15, .12, .1}));
}

// Each otherwise turned, lowered until it touches.
PatchScene laid(const std::string& kind, const std::string& law) {
  PatchScene s(wavy_mesh(20, .002), .05, .5, 1e8, .5);
  if (kind != "plain") s.law = make_round_patch_forces(law, true);
  const GrainShape g = shape(kind);
  for (int k = 0; k < kRow * kRow; ++k) {
    const Vec3 at(kPitch * (k % kRow - 4), kPitch * (k / kRow - 4), g.radius + .002);
    const Quat turn(Eigen::AngleAxisd(.3 * k, Vec3(1, .1 * k, -1).normalized()));
    s.travel.push_back(0);
    add_grain(s.bodies, s.shapes, s.shapes.add(g), 0, 2600, at, turn);
    do {
      s.bodies.x[k].z() -= 1e-3;
      s.evaluate_afresh();
    } while (count_contacts(s.contacts) <= k);
  }
  s.context.dt = 2e-5;
  return s;
}

TEST(SurfaceThreads, the_same_bits_on_any_number) {
  for (const auto& [kind, law] :
       {std::pair("plain", ""), std::pair("sphere", "hertz_mindlin"),
        std::pair("dilated", "hertz_mindlin"), std::pair("dilated", "hertz_flat")}) {
    const PatchScene start = laid(kind, law);
    PatchScene one = start;
    for (int k = 0; k < 100; ++k) one.step();
    EXPECT_GT(count_contacts(one.contacts), kRow * kRow / 2) << kind;
    for (const int threads : {2, 8}) {
      PatchScene many = start;
      many.context.threads = threads;
      for (int k = 0; k < 100; ++k) many.step();
      EXPECT_EQ(one.bodies.x, many.bodies.x) << kind << threads;
      EXPECT_EQ(one.bodies.L, many.bodies.L) << kind << threads;
      EXPECT_EQ(one.patch.force, many.patch.force) << kind << threads;
      EXPECT_EQ(one.contacts.wake, many.contacts.wake) << kind << threads;
    }
  }
}

TEST(SurfaceThreads, the_first_grain_that_goes_through_is_named) {
  for (const auto& [kind, law] : {std::pair("plain", ""), std::pair("dilated", "hertz_mindlin")}) {
    PatchScene s = laid(kind, law);
    for (int k = 0; k < kRow * kRow; ++k)
      if (k % 10 == 7) s.bodies.x[k].z() -= .08;
    s.context.threads = 8;
    try {
      s.evaluate_afresh();
      FAIL() << kind;
    } catch (const RunError& e) {
      EXPECT_NE(std::string(e.what()).find("grain 7 goes"), std::string::npos) << e.what();
    }
  }
}

}  // namespace
}  // namespace trackbed::dem
