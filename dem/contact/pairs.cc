#include "dem/contact/pairs.h"

#include <numeric>
#include <type_traits>

namespace trackbed::dem {
namespace {

template <class T>
void zero_resize(std::vector<T>& v, int n) {
  v.resize(n, T(0));
}
void zero_resize(std::vector<Vec3>& v, int n) { v.resize(n, Vec3::Zero()); }

}  // namespace

void Pairs::resize(int pairs) {
  for_each_array(*this, [pairs](const char*, auto& v) { zero_resize(v, pairs); });
}

void Pairs::rearrange(const std::vector<int>& old) {
  for_each_array(*this, [&old](const char*, auto& v) {
    std::remove_reference_t<decltype(v)> next;
    zero_resize(next, static_cast<int>(old.size()));
    for (std::size_t p = 0; p < old.size(); ++p)
      if (old[p] >= 0) next[p] = v[old[p]];
    v.swap(next);
  });
}

void Pairs::keep_resistance() {
  if (resists) return;
  resists = true;
  resize(size());
}

void Pairs::index_bodies(int bodies) {
  ball_a.clear();  // and what else is found with them
  kind_first.fill(0);
  for (const std::uint8_t k : kind) ++kind_first[k + 1];
  std::partial_sum(kind_first.begin(), kind_first.end(), kind_first.begin());
  for (int k = 0; k < kPairKinds; ++k) {
    kind_busy[k] = kind_first[k + 1];
    while (kind_busy[k] > kind_first[k] && !touching[kind_busy[k] - 1]) --kind_busy[k];
  }
  first.assign(bodies + 1, 0);
  for (int p = 0; p < size(); ++p) ++first[a[p] + 1], ++first[b[p] + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  incident.resize(2 * a.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int p = 0; p < size(); ++p) incident[next[a[p]]++] = p, incident[next[b[p]]++] = ~p;
}

int count_contacts(const Pairs& pairs) {
  return std::accumulate(pairs.touching.begin(), pairs.touching.end(), 0);
}

}  // namespace trackbed::dem
