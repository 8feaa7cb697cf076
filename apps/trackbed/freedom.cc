#include "apps/trackbed/freedom.h"

#include <map>
#include <sstream>

#include "dem/motion/bodies.h"

namespace trackbed::apps {

int freedom_of(const std::string& text) {
  if (text == "six") return dem::kFree;
  if (text == "vertical") return dem::kMoveZ;
  static const std::map<std::string, int> bits{{"x", dem::kMoveX},      {"y", dem::kMoveY},
                                               {"z", dem::kMoveZ},      {"turn x", dem::kTurnX},
                                               {"turn y", dem::kTurnY}, {"turn z", dem::kTurnZ}};
  int freedom = 0;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) {
    const auto first = word.find_first_not_of(' ');
    if (first == std::string::npos) return -1;
    const auto bit = bits.find(word.substr(first, word.find_last_not_of(' ') - first + 1));
    if (bit == bits.end() || freedom & bit->second) return -1;
    freedom |= bit->second;
  }
  return freedom;
}

}  // namespace trackbed::apps
