// A load history from a CSV file with the columns time_s and load_N: one load cycle, straight
// between its rows, repeated.
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

struct LoadTable {
  std::vector<double> time, load;  ///< [s] from 0, [N]

  double period() const { return time.back(); }
  double at(double t) const;  ///< load [N] at any time since the cycles began [s]
  double peak() const;        ///< time of the largest load, as a share of the period
};

/// \throws InputError, one line that starts with `file` and names the line at fault: no such file,
/// a header other than time_s,load_N, cells that are not two numbers, fewer than three rows, time
/// that does not start at 0 or does not rise, a negative load, ends that differ (the cycle
/// repeats), the largest load at an end.
LoadTable read_load_table(const std::string& file);

}  // namespace trackbed::apps
