// Picking entries of an array.
#pragma once
#include <utility>
#include <vector>

namespace trackbed {

/// v becomes v[order[0]], v[order[1]], ...
template <class T>
void gather(std::vector<T>& v, const std::vector<int>& order) {
  std::vector<T> picked;
  picked.reserve(order.size());
  for (const int i : order) picked.push_back(v[i]);
  v = std::move(picked);
}

}  // namespace trackbed
