// A hundred grains on an elastic subgrade: the same bits for any number of threads and from run to
// run, and no energy from nowhere.
#include <gtest/gtest.h>

#include <cstring>

#include "coupling_scene.h"

namespace trackbed::coupling {
namespace {

std::vector<double> state_after(int threads, double* closed = nullptr) {
  World w = bed(5, 4);
  for (int i = 0; i < w.bodies.grains; ++i) w.bodies.v[i] = {.3, 0, -3};
  dem::StepContext c = context(4e-5, {0, 0, -9.81}, threads);
  start(w, c);
  run(w, c, 200);
  EXPECT_GT(dem::count_contacts(w.surfaces[0].contacts), 5);
  if (closed) *closed = closure(w.start, stores(w, c.gravity), flows(w)) / w.start.total();
  std::vector<double> all;
  for (int i = 0; i < w.bodies.size(); ++i)
    for (int d = 0; d < 3; ++d)
      for (const auto* v : {&w.bodies.x, &w.bodies.v, &w.bodies.L, &w.bodies.force})
        all.push_back((*v)[i][d]);
  std::vector<double> structure;
  w.surfaces[0].structure->save(structure);
  all.insert(all.end(), structure.begin(), structure.end());
  return all;
}

TEST(Threads, same_bits) {
  double closed = 0;
  const std::vector<double> one = state_after(1, &closed);
  EXPECT_LT(std::abs(closed), 1e-3);
  for (const int threads : {1, 2, 8}) {
    const std::vector<double> other = state_after(threads);
    ASSERT_EQ(other.size(), one.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(double)), 0) << threads;
  }
}

}  // namespace
}  // namespace trackbed::coupling
