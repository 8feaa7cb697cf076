#include "dem/grain/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <numeric>

namespace trackbed::dem {
namespace {

size_t edit_distance(const std::string& a, const std::string& b) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) ==
           std::tolower(static_cast<unsigned char>(y));
  };
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (same(a[i], b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(const std::string& given, const std::vector<std::string>& names) {
  if (names.empty()) return "";
  if (given.size() >= 3)
    for (const std::string& name : names)
      if (name.find(given) != std::string::npos) return name;
  return *std::min_element(names.begin(), names.end(), [&](const auto& a, const auto& b) {
    return edit_distance(given, a) < edit_distance(given, b);
  });
}

std::string unknown_name(const std::string& noun, const std::string& given,
                         const std::vector<std::string>& names) {
  std::string text = "no " + noun + " '" + given + "'; did you mean '" +
                     nearest_name(given, names) + "'? (known: ";
  for (size_t k = 0; k < names.size(); ++k) text += (k ? ", " : "") + names[k];
  return text + ")";
}

}  // namespace trackbed::dem
