// Times of a step taken in turn, so that a machine whose speed drifts treats all alike.
#pragma once
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <thread>
#include <vector>

#include "motion_scene.h"

namespace trackbed::dem {

inline double seconds_of(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

inline double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
  return v[v.size() / 2];
}

/// Median of so many steps [s].
inline double median_step(Scene& s, int steps, clockid_t clock = CLOCK_PROCESS_CPUTIME_ID) {
  std::vector<double> seconds;
  for (int k = 0; k < steps; ++k) {
    const double start = seconds_of(clock);
    s.step();
    seconds.push_back(seconds_of(clock) - start);
  }
  return median(seconds);
}

/// How a bed's steps gain by threads, by the wall's clock. `machine`: the same bed once for each
/// thread, all at once, one thread each: as much as this machine's processors give together.
struct ThreadGain {
  double gain, machine;
};

/// Medians of `rounds`, each some steps on one thread, then on all, then of all beds at once.
inline ThreadGain gain_of_threads(Scene s, int threads, int rounds = 15, int steps = 40) {
  std::vector<double> gains, machine;
  std::vector<Scene> beds(threads, s);
  for (int k = 0; k < rounds; ++k) {
    s.context.threads = 1;
    const double one = median_step(s, steps, CLOCK_MONOTONIC);
    s.context.threads = threads;
    gains.push_back(one / median_step(s, steps, CLOCK_MONOTONIC));
    std::vector<double> seconds(threads);
    std::vector<std::thread> side;
    for (int t = 0; t < threads; ++t) {
      beds[t].context.threads = 1;
      side.emplace_back([&, t] { seconds[t] = median_step(beds[t], steps, CLOCK_MONOTONIC); });
    }
    for (std::thread& t : side) t.join();
    machine.push_back(threads * one / *std::max_element(seconds.begin(), seconds.end()));
  }
  return {median(gains), median(machine)};
}

inline void print_gain(const ThreadGain& g, int threads) {
  std::printf("  %d threads: %.2f times as fast as 1; as many beds at once, a thread each: %.2f\n",
              threads, g.gain, g.machine);
}

}  // namespace trackbed::dem
