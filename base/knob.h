// A knob: a numerical choice that trades accuracy for time. Declared as plain data by the library
// that owns it; `trackbed cost` runs its ladder and draws error against time.
#pragma once
#include <string>
#include <vector>

namespace trackbed {

/// The ladder goes from cheap to exact. It is either a list of words (`rungs`), or the scene's own
/// number (each of a list of numbers) times `factor`^k, k = -cheaper ... finer; `factor` < 1 where
/// a smaller value is more exact.
struct Knob {
  std::string name;      ///< on the command line
  std::string path;      ///< "Section/Key" in a scene
  std::string quantity;  ///< what it is about: a quantity of `trackbed cost`
  std::string meaning;   ///< which error it makes
  std::vector<std::string> rungs;
  std::vector<std::string> also;  ///< "Section/Key=value" that the last rung cannot do without
  std::vector<std::string> with;  ///< the same of every rung but the scene's own
  double factor = 1;
  int cheaper = 0, finer = 0;
  bool whole = false;  ///< the numbers are counts: rounded, at least 1
  double order = 0;    ///< expected p in error ~ h^p, h the value or its inverse; 0 = none expected
  std::string needs;   ///< "Section/Key=value" or "Section/Key!=value" of scenes it matters in
};

}  // namespace trackbed
