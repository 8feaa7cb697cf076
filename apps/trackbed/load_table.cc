#include "apps/trackbed/load_table.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/parameter_text.h"
#include "base/error.h"

namespace trackbed::apps {
double LoadTable::at(double t) const {
  t -= std::floor(t / period()) * period();
  const auto after = std::upper_bound(time.begin(), time.end(), t);
  const std::size_t k = std::clamp<std::size_t>(after - time.begin(), 1, time.size() - 1);
  return load[k - 1] + (load[k] - load[k - 1]) * (t - time[k - 1]) / (time[k] - time[k - 1]);
}

double LoadTable::peak() const {
  return time[std::max_element(load.begin(), load.end()) - load.begin()] / period();
}

LoadTable read_load_table(const std::string& file) {
  std::ifstream in(file);
  if (!in)
    throw InputError(file + ": no such file (a table is looked for next to the scene's file)");
  int line = 0;
  const auto refuse = [&](const std::string& why) {
    throw InputError(file + ":" + std::to_string(line) + ": " + why);
  };
  LoadTable table;
  for (std::string text; std::getline(in, text);) {
    ++line;
    text = trimmed(text);
    if (text.empty() || text[0] == '#') continue;
    const auto comma = text.find(',');
    const std::string left = trimmed(text.substr(0, comma));
    const std::string right = comma == std::string::npos ? "" : trimmed(text.substr(comma + 1));
    if (table.time.empty() && left == "time_s") {
      if (right != "load_N") refuse("the header '" + text + "' is not time_s,load_N");
      continue;
    }
    double t = 0, f = 0;
    if (!parse_number(left, t) || !parse_number(right, f))
      refuse("'" + text + "' is not two numbers, time_s,load_N");
    if (table.time.empty() && t != 0) refuse("the first time is " + shortest(t) + " s, must be 0");
    if (!table.time.empty() && t <= table.time.back())
      refuse("time " + shortest(t) + " s follows " + shortest(table.time.back()) +
             " s; times must rise");
    if (f < 0) refuse("load " + shortest(f) + " N, must be 0 or more (a wheel does not pull)");
    table.time.push_back(t);
    table.load.push_back(f);
  }
  if (table.time.size() < 3)
    throw InputError(file + ": " + std::to_string(table.time.size()) +
                     " rows of time_s,load_N; three or more are needed");
  const double largest = *std::max_element(table.load.begin(), table.load.end());
  if (std::abs(table.load.front() - table.load.back()) > 1e-6 * largest)
    refuse("the last load " + shortest(table.load.back()) + " N is not the first, " +
           shortest(table.load.front()) + " N; the cycle is repeated, so its ends must agree");
  const double peak = table.peak();
  if (!(peak > 0 && peak < 1)) refuse("the largest load stands at an end; it must lie between");
  return table;
}

}  // namespace trackbed::apps
