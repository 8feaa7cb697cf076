// One line of text from pieces: text("E = ", 3.0, " Pa").
#pragma once
#include <sstream>
#include <string>

namespace trackbed::fem {

template <class... Pieces>
std::string text(const Pieces&... pieces) {
  std::ostringstream out;
  (out << ... << pieces);
  return out.str();
}

/// The keys of a map or the strings of a list as "a, b, c".
template <class Container>
std::string names_of(const Container& all) {
  std::string out;
  for (const auto& entry : all) {
    if constexpr (std::is_convertible_v<decltype(entry), std::string>)
      out += (out.empty() ? "" : ", ") + std::string(entry);
    else
      out += (out.empty() ? "" : ", ") + entry.first;
  }
  return out;
}

}  // namespace trackbed::fem
