// The known name nearest to a mistyped one, for error messages.
#pragma once
#include <string>
#include <vector>

namespace trackbed::dem {

/// A name that contains the given text, else by edit distance (insert, delete, replace; letter case
/// ignored); "" when `names` is empty.
std::string nearest_name(const std::string& given, const std::vector<std::string>& names);

/// "no NOUN 'given'; did you mean 'x'? (known: a, b, …)"
std::string unknown_name(const std::string& noun, const std::string& given,
                         const std::vector<std::string>& names);

}  // namespace trackbed::dem
