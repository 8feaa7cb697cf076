// A list taken by several threads in shares: every share once, whoever takes it.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "dem/contact/shares.h"

namespace trackbed::dem {
namespace {

// Until `ready`, at most ten seconds: a fault must not hang.
template <class Ready>
void wait_until(Ready&& ready) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (!ready() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
}

TEST(Shares, each_is_taken_once) {
  for (const int threads : {1, 2, 3, 8, 200})
    for (const int shares : {0, 1, 2, 7, 64, 1000})
      for (const int busy : {0, 1, shares / 3, shares}) {
        if (busy > shares) continue;
        std::vector<std::atomic<int>> taken(shares);
        by_shares(shares, busy, threads, [&](int s, int) { ++taken.at(s); });
        for (int s = 0; s < shares; ++s)
          EXPECT_EQ(taken[s], 1) << s << " of " << shares << ", " << busy << " busy, " << threads;
      }
}

// What keeps a thread's pairs in its own cache: it takes the same ones every time, half of those
// that are work and half of the others, if neither is faster: here they go in step.
TEST(Shares, a_thread_has_its_own) {
  std::vector<int> by(10, -1);
  std::atomic<int> begun{0};
  int taken[2] = {0, 0};
  by_shares(10, 4, 2, [&](int s, int me) {
    by[s] = me;
    ++begun;
    const int together = 2 * std::min(++taken[me], 5);
    wait_until([&] { return begun >= together; });
  });
  EXPECT_EQ(by, (std::vector<int>{0, 0, 1, 1, 0, 0, 0, 1, 1, 1}));
}

// A thread that is done helps one that is held up.
TEST(Shares, who_is_done_helps) {
  std::atomic<int> done{0};
  by_shares(10, 10, 2, [&](int s, int) {
    if (s == 0) {
      wait_until([&] { return done >= 9; });
      EXPECT_EQ(done, 9) << "the held-up thread's own shares are left";
    }
    ++done;
  });
  EXPECT_EQ(done, 10);
}

// Who runs scenes side by side, a thread each, does not make a scene's only thread another than its
// first: there is scratch memory for that one.
TEST(Shares, one_thread_is_the_first_in_a_team_too) {
  std::atomic<int> taken{0}, others{0};
#pragma omp parallel num_threads(4)
  for (const int threads : {1, 3})
    by_shares(10, 5, threads, [&](int, int t) { ++taken, others += t >= threads; });
  EXPECT_EQ(taken, 4 * 2 * 10);
  EXPECT_EQ(others, 0);
}

}  // namespace
}  // namespace trackbed::dem
