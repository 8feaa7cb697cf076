// A million steps of a bed at rest, undamped: no creep, no heating, no energy from nowhere.
#include <gtest/gtest.h>

#include "dem/grain/random.h"
#include "motion_scene.h"

namespace trackbed::dem {
namespace {

Scene quiet_box() {
  Scene s(2e8, .5);
  Random random(4);
  const double size = .045, cell = .8 * size;
  for (int i = 0; i < 48; ++i) {
    std::vector<Vec3> points;
    while (points.size() < 16) {
      const Vec3 p(random.uniform(-1, 1), random.uniform(-.85, .85), random.uniform(-.7, .7));
      if (p.norm() < 1 && p.norm() > .5) points.push_back(size / 2 * p);
    }
    const Vec3 at(i % 4 + .5, i / 4 % 4 + .5, i / 16 + .5);
    add_grain(s.bodies, s.shapes, s.shapes.add(make_grain_shape(convex_hull(points))), 0, 2600,
              cell * at, turn_about(random.direction(), random.uniform(0, 3)));
  }
  add_container(s.bodies, s.shapes, {0, 0, 0}, {4 * cell, 4 * cell, 10 * cell}, .1, 0);
  s.prepare();
  s.context.dt = .3 * expected_limit(s.bodies, s.shapes, s.materials, {}).dt;
  s.context.local_damping = .5;
  s.run(1);
  s.context.local_damping = .8;
  s.run(2);
  s.context.local_damping = 0;
  return s;
}

TEST(Bed, rests_for_a_million_steps) {
  Scene s = quiet_box();
  const std::vector<Vec3> before = s.bodies.x;
  s.flow = {}, s.start = s.now();
  double kinetic_early = 0, kinetic_late = 0;
  for (long k = 0; k < 1000000; ++k) {
    s.step();
    if (k % 1000 == 0) (k < 500000 ? kinetic_early : kinetic_late) += s.now().kinetic;
  }
  double moved = 0;
  for (int i = 0; i < s.bodies.grains; ++i)
    moved = std::max(moved, (s.bodies.x[i] - before[i]).norm());
  std::printf("moved at most %.2e m, kinetic %.2e then %.2e J, closure %.2e J of %.2e J stored\n",
              moved, kinetic_early / 500, kinetic_late / 500, s.closure(), s.now().normal);
  EXPECT_GT(count_contacts(s.pairs), 100);
  EXPECT_LT(moved, 1e-6);
  EXPECT_LE(kinetic_late, kinetic_early);
  EXPECT_LT(std::abs(s.closure()), 1e-6 * s.now().normal);
}

}  // namespace
}  // namespace trackbed::dem
