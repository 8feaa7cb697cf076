// A loop over a list by several threads, a share of it at a time. Each thread has shares of its own,
// the same in every step, so that what it writes stays in its own cache; one that is done takes
// shares of the others. Included by the loops over contacts, nowhere else.
#pragma once
#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>

namespace trackbed::dem {

/// Shares that one thread takes first: a run of those that are most of the work, then one of the
/// rest.
struct alignas(64) OwnShares {
  std::atomic<int> next{0};
  int busy_first = 0, busy = 0, idle_first = 0, idle = 0;

  /// The next one, -1 when all are taken.
  int take() {
    const int k = next.fetch_add(1, std::memory_order_relaxed);
    return k < busy ? busy_first + k : k < busy + idle ? idle_first + k - busy : -1;
  }
};

/// work(s, t) for each s in [0, shares), once, on up to `threads` threads; t in [0, threads) is which
/// of them, whoever calls. The first `busy` are most of the work: each thread gets as many of them.
template <class Work>
void by_shares(int shares, int busy, int threads, Work&& work) {
  constexpr int kMost = 64;
  threads = std::min({threads, kMost, shares});
  if (threads <= 1) {
    for (int s = 0; s < shares; ++s) work(s, 0);
    return;
  }
  std::array<OwnShares, kMost> own;
  const auto cut = [&](int n, int k) { return static_cast<int>(long(n) * k / threads); };
  for (int k = 0; k < threads; ++k) {
    own[k].busy_first = cut(busy, k), own[k].busy = cut(busy, k + 1) - cut(busy, k);
    const int idle = shares - busy;
    own[k].idle_first = busy + cut(idle, k), own[k].idle = cut(idle, k + 1) - cut(idle, k);
  }
#pragma omp parallel num_threads(threads)
  for (int k = 0; k < threads; ++k) {
    const int me = omp_get_thread_num();
    OwnShares& from = own[(me + k) % threads];
    for (int s = from.take(); s >= 0; s = from.take()) work(s, me);
  }
}

/// What the shares find together: the least of all.
inline void lower_to(int value, std::atomic<int>& least) {
  int now = least.load();
  while (value < now && !least.compare_exchange_weak(now, value)) {
  }
}

}  // namespace trackbed::dem
