// The CSV files of a run that grow with time: history, energy, cycles, compaction.
#pragma once
#include <optional>
#include <string>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/simulation/stage.h"

namespace trackbed::apps {

class Recorder {
 public:
  static constexpr int kNew = -1, kKeepAll = -2;

  /// New files in `folder`.
  explicit Recorder(const std::string& folder);

  /// Goes on with files that hold at least these rows (history, energy, cycles, compaction); what
  /// came after a checkpoint is cut off. -1: a new file; kKeepAll: all rows of the file there is.
  /// Throws InputError naming the file.
  Recorder(const std::string& folder, const std::vector<int>& rows);

  /// A line of history and, while a ledger is open, of energy; keeps its worst closure.
  void sample(Run&, const Stage&);

  /// The line of energy alone.
  void energy(Run&, const Stage&);

  /// A line of cycles (loading) at the end of a load cycle.
  void cycle(const Run&, const Stage&, double load_start, double u_start);

  /// A line of compaction at the end of a tamping cycle (0 = before the first).
  void compaction(const Run&);

  std::vector<int> rows() const;
  void flush();

 private:
  CsvWriter history_, energy_, cycles_, compaction_;
};

}  // namespace trackbed::apps
