// Degrees of freedom of a rigid sleeper, by name.
#pragma once
#include <string>

namespace trackbed::apps {

/// "six", "vertical", or a list such as "z, turn y": the bits of dem::Freedom; -1 where a word is
/// none of them or stands there twice.
int freedom_of(const std::string& text);

}  // namespace trackbed::apps
