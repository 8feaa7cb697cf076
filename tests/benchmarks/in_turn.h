// Times of a step taken in turn, so that a machine whose speed drifts treats all alike.
#pragma once
#include <omp.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
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

/// Some steps on one thread, on all, and of all beds at once, in turn for `rounds`. Where others use
/// the machine too its processors are slowed down for seconds at a time, by a third and more, and not
/// all ways alike: of each way the time counts that a tenth of the rounds stay below.
inline ThreadGain gain_of_threads(Scene s, int threads, int rounds = 60, int steps = 20) {
  std::vector<double> one, all, apart;
  std::vector<Scene> beds(threads, s);
  for (Scene& bed : beds) bed.context.threads = 1;
  for (int k = 0; k < rounds; ++k) {
    s.context.threads = 1;
    one.push_back(median_step(s, steps, CLOCK_MONOTONIC));
    s.context.threads = threads;
    all.push_back(median_step(s, steps, CLOCK_MONOTONIC));
    std::vector<double> seconds(threads);
#pragma omp parallel num_threads(threads)
    {
      const int t = omp_get_thread_num();
      seconds[t] = median_step(beds[t], steps, CLOCK_MONOTONIC);
    }
    apart.push_back(*std::max_element(seconds.begin(), seconds.end()));
  }
  const auto fast = [](std::vector<double>& v) {
    std::nth_element(v.begin(), v.begin() + v.size() / 10, v.end());
    return v[v.size() / 10];
  };
  return {fast(one) / fast(all), threads * fast(one) / fast(apart)};
}

inline void print_gain(const ThreadGain& g, int threads) {
  std::printf("  %d threads: %.2f times as fast as 1; as many beds at once, a thread each: %.2f\n",
              threads, g.gain, g.machine);
}

}  // namespace trackbed::dem
