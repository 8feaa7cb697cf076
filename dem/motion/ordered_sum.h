// A sum over [0, n) whose order depends on n alone, so that it is bitwise the same for any number
// of threads: at most 64 blocks, each summed in order, then the blocks in order.
#pragma once
#include <algorithm>
#include <array>

#include "dem/contact/eight_vectors.h"

namespace trackbed::dem {

/// Sum of term(i), i in [0, n), in parallel; T needs T() = 0 and +=.
template <class T, class Term>
T ordered_sum(int n, int threads, Term&& term) {
  constexpr int kBlocks = 64;
  std::array<T, kBlocks> part{};
  const int size = std::max(16, (n + kBlocks - 1) / kBlocks);
  const int blocks = (n + size - 1) / size;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (int k = 0; k < blocks; ++k) {
    T sum{};
    for (int i = k * size; i < std::min(n, (k + 1) * size); ++i) sum += term(i);
    part[k] = sum;
  }
  T total{};
  for (int k = 0; k < blocks; ++k) total += part[k];
  return total;
}

/// Sum of an array, by eight sums side by side.
inline double ordered_sum(const double* x, int n, int threads) {
  constexpr int kFew = 20000;  // as quickly added as a thread is woken
  struct Sums {
    Eight of = 0;
    void operator+=(const Sums& o) { of = of + o.of; }
  };
  const Sums sums = ordered_sum<Sums>(n / 8, n > kFew ? threads : 1,
                                      [&](int row) { return Sums{Eight::load(x + 8 * row)}; });
  double sum = sum_first(sums.of, 8);
  for (int i = n / 8 * 8; i < n; ++i) sum += x[i];
  return sum;
}

}  // namespace trackbed::dem
