// Where a long run stands: a bar that is redrawn in place on a terminal, a line now and then in a
// log. Written to standard error, so that standard output stays for results.
#pragma once
#include <chrono>
#include <string>

namespace trackbed::apps {

class Progress {
 public:
  Progress();  ///< a terminal is found out by isatty(2)
  explicit Progress(bool terminal) : terminal_(terminal) {}
  ~Progress();

  /// A stage begins: name ("tamping"), simulated time now and at its end [s].
  void begin(const std::string& stage, double time, double end);

  /// The same for work without a simulated time: how much is done, and how much there is, in
  /// seconds as expected; the time that is left follows from the pace so far.
  void begin_work(const std::string& stage, double done, double total);

  /// Call as often as you like; draws at most 5 times a second (log: every 10 s).
  /// `detail` is what matters in this stage now ("settlement 1.23 mm", "1540 kg/m3").
  void update(double time, const std::string& detail);

  /// True when update() would draw: spares the caller making up `detail`.
  bool due() const;

  /// The stage's last line stays on the screen.
  void finish(double time, const std::string& detail);

  /// Work without simulated time, such as sizing a library: the share that is done, 0 … 1. Shown
  /// once it has taken a second or two.
  void portion(const std::string& work, double share);

  /// A line of its own, above the bar.
  void note(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double time, const std::string& detail, bool last);
  void clear();
  void show(std::string line, double share, const std::string& tail, bool last);

  bool terminal_;
  bool drawn_ = false;  ///< a bar stands on the current line
  bool active_ = false;
  bool work_ = false;  ///< not a simulated time
  std::string stage_;
  double start_ = 0, end_ = 0;
  Clock::time_point begun_, shown_;
};

/// "1 h 05 min", "3 min 20 s", "45 s"
std::string duration_text(double seconds);

}  // namespace trackbed::apps
