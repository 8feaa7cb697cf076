// The name a user most likely meant.
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

/// Levenshtein distance, letter case ignored: the fewest insertions, removals and replacements.
int edit_distance(const std::string& a, const std::string& b);

/// The name with the least distance; the first of equals. Empty only if `names` is.
std::string nearest_name(const std::string& given, const std::vector<std::string>& names);

/// "a, b or c"
std::string join_names(const std::vector<std::string>& names);

}  // namespace trackbed::apps
