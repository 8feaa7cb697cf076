// Memory for the arrays of many shapes, which contacts read in no order: large blocks, on the
// system's large pages where it has them (with small ones finding the page costs more than reading
// it).
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

namespace trackbed::dem {

/// Hands out memory that never moves and lives as long as the pool or a copy of it. A copy shares
/// what was handed out so far.
class LinePool {
 public:
  LinePool() = default;
  LinePool(const LinePool& o) : blocks_(o.blocks_) {}
  LinePool& operator=(const LinePool& o) {
    blocks_ = o.blocks_;
    left_ = 0;
    return *this;
  }
  /// Zeros, from the start of a 64-byte line on. Throws std::bad_alloc.
  double* take(std::size_t reals);

 private:
  std::vector<std::shared_ptr<double>> blocks_;
  double* next_ = nullptr;
  std::size_t left_ = 0, block_ = 0;  // reals
};

}  // namespace trackbed::dem
