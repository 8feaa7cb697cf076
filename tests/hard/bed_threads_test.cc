// A settled bed of grains gives the same bits on one, two and eight threads, with and without what
// resists turning.
#include <gtest/gtest.h>

#include <cstring>

#include "settled_bed.h"

namespace trackbed::dem {
namespace {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// A small bed that is still coming to rest: pairs come and go, slide and stick.
Scene moving_bed(int threads, double torsion, int steps) {
  static const Scene loose = loose_bed(600);
  Scene s = loose;
  s.context.gravity = {0, 0, -60};  // sooner there
  s.resistance.torsion = torsion;
  s.resistance.rolling = torsion;
  s.context.threads = threads;
  s.context.local_damping = .2;
  s.prepare();
  s.context.dt = .4 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  for (int k = 0; k < steps; ++k) s.step();
  return s;
}

void compare(double torsion, int steps, int least_contacts) {
  const Scene one = moving_bed(1, torsion, steps);
  EXPECT_GT(count_contacts(one.pairs), least_contacts);
  for (const int threads : {2, 8}) {
    const Scene s = moving_bed(threads, torsion, steps);
    EXPECT_TRUE(same_bits(one.bodies.x, s.bodies.x)) << threads;
    EXPECT_TRUE(same_bits(one.bodies.L, s.bodies.L)) << threads;
    EXPECT_TRUE(same_bits(one.pairs.force, s.pairs.force)) << threads;
    EXPECT_TRUE(same_bits(one.pairs.friction, s.pairs.friction)) << threads;
    EXPECT_EQ(one.flow.total(), s.flow.total()) << threads;
  }
}

TEST(Bed, has_the_same_bits_on_any_threads) { compare(0, 1200, 60); }
TEST(Bed, has_them_with_resistance_to_turning) { compare(1, 1200, 60); }

}  // namespace
}  // namespace trackbed::dem
