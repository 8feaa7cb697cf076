#include "dem/contact/line_pool.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>

namespace trackbed::dem {

double* LinePool::take(std::size_t reals) {
  constexpr std::size_t kLine = 8, kLargePage = (std::size_t(2) << 20) / sizeof(double);
  constexpr std::size_t kFirst = kLargePage / 32, kMost = 4 * kLargePage;
  reals = (reals + kLine - 1) / kLine * kLine;
  if (reals > left_) {
    block_ = std::min(std::max(2 * block_, kFirst), kMost);
    const bool large = std::max(block_, reals) >= kLargePage;
    const std::size_t unit = large ? kLargePage : kLine;
    left_ = (std::max(block_, reals) + unit - 1) / unit * unit;
    const std::size_t bytes = left_ * sizeof(double);
    next_ = static_cast<double*>(std::aligned_alloc(unit * sizeof(double), bytes));
    if (!next_) throw std::bad_alloc();
    blocks_.emplace_back(next_, [](double* p) { std::free(p); });
#ifdef MADV_HUGEPAGE
    if (large) madvise(next_, bytes, MADV_HUGEPAGE);  // a wish: it works without
#endif
  }
  double* taken = next_;
  next_ += reals, left_ -= reals;
  std::memset(taken, 0, reals * sizeof(double));
  return taken;
}

}  // namespace trackbed::dem
