// A short name for a text: 64-bit FNV-1a. Not for secrets; stored packings are found by it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace trackbed::apps {

/// FNV-1a, offset basis 14695981039346656037, prime 1099511628211 (Fowler, Noll, Vo 1991).
constexpr std::uint64_t fnv1a(std::string_view text, std::uint64_t hash = 14695981039346656037ull) {
  for (char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

/// 16 hexadecimal digits.
inline std::string hash_name(std::string_view text) {
  constexpr char digits[] = "0123456789abcdef";
  std::uint64_t hash = fnv1a(text);
  std::string name(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) name[i] = digits[hash & 15];
  return name;
}

}  // namespace trackbed::apps
