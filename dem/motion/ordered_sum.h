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

/// Sum of an array, eight at a time.
inline double ordered_sum(const double* x, int n, int threads) {
  constexpr int kFew = 20000;  // as quickly added as a thread is woken
  return ordered_sum<double>((n + 7) / 8, n > kFew ? threads : 1, [&](int row) {
    Eightfold e;
    for (int i = 8 * row; i < std::min(n, 8 * row + 8); ++i) e.add(i);
    e.complete();
    return sum_first(read(x, e), e.count);
  });
}

}  // namespace trackbed::dem
