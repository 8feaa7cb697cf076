#include "apps/trackbed/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace trackbed::apps {
namespace {

constexpr double terminal_interval = 0.2;  // [s]
constexpr double log_interval = 10.0;      // [s]
constexpr int bar_width = 24;

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

int terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
  char text[48];
  const long total = std::lround(std::max(0.0, std::min(seconds, 3.6e9)));
  if (total >= 3600)
    std::snprintf(text, sizeof text, "%ld h %02ld min", total / 3600, total / 60 % 60);
  else if (total >= 60)
    std::snprintf(text, sizeof text, "%ld min %02ld s", total / 60, total % 60);
  else
    std::snprintf(text, sizeof text, "%ld s", total);
  return text;
}

Progress::Progress() : Progress(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputc('\n', stderr);
}

void Progress::begin(const std::string& stage, double time, double end) {
  stage_ = stage;
  start_ = time;
  end_ = end;
  begun_ = shown_ = Clock::now();
  active_ = true;
  work_ = false;
  if (terminal_) draw(time, "", false);
}

void Progress::begin_work(const std::string& stage, double done, double total) {
  begin(stage, done, total);
  work_ = true;
}

bool Progress::due() const {
  return active_ && seconds_since(shown_) >= (terminal_ ? terminal_interval : log_interval);
}

void Progress::update(double time, const std::string& detail) {
  if (due()) draw(time, detail, false);
}

void Progress::finish(double time, const std::string& detail) {
  if (active_) draw(time, detail, true);
  active_ = false;
}

void Progress::note(const std::string& line) {
  clear();
  std::fprintf(stderr, "%s\n", line.c_str());
}

void Progress::clear() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
  drawn_ = false;
}

void Progress::draw(double time, const std::string& detail, bool last) {
  shown_ = Clock::now();
  const double elapsed = seconds_since(begun_);
  const double done = time - start_;
  const double share = end_ > start_ ? std::clamp(done / (end_ - start_), 0.0, 1.0) : 1.0;
  const double rate = elapsed > 0 ? done / elapsed : 0;

  char head[160], tail[160] = "";
  std::snprintf(head, sizeof head, "%-10s", stage_.c_str());
  if (work_ && last)
    std::snprintf(tail, sizeof tail, " took %s", duration_text(elapsed).c_str());
  else if (work_ && rate > 0)
    std::snprintf(tail, sizeof tail, " %3.0f %%  %s left", 100 * share,
                  duration_text((end_ - time) / rate).c_str());
  else if (work_)
    std::snprintf(tail, sizeof tail, " %3.0f %%", 100 * share);
  else if (last)
    std::snprintf(tail, sizeof tail, " t = %.4f s, took %s", time, duration_text(elapsed).c_str());
  else if (rate > 0)
    std::snprintf(tail, sizeof tail, " %3.0f %%  t = %.4f of %.4g s, %.2g s/min, %s left",
                  100 * share, time, end_, 60 * rate, duration_text((end_ - time) / rate).c_str());
  else
    std::snprintf(tail, sizeof tail, " %3.0f %%  t = %.4f of %.4g s", 100 * share, time, end_);

  std::string text = tail;
  if (!detail.empty()) text += ", " + detail;
  show(head, share, text, last);
}

void Progress::portion(const std::string& work, double share) {
  if (!active_ || stage_ != work) {
    stage_ = work;
    begun_ = shown_ = Clock::now();
    active_ = true;
  }
  const double elapsed = seconds_since(begun_);
  const bool last = share >= 1;
  active_ = !last;
  if (elapsed < 1.5 ||
      (!last && seconds_since(shown_) < (terminal_ ? terminal_interval : log_interval)))
    return;
  shown_ = Clock::now();
  char text[80];
  if (last)
    std::snprintf(text, sizeof text, " took %s", duration_text(elapsed).c_str());
  else
    std::snprintf(text, sizeof text, " %3.0f %%, %s left", 100 * share,
                  duration_text(elapsed * (1 / share - 1)).c_str());
  show(work, share, text, last);
}

void Progress::show(std::string line, double share, const std::string& tail, bool last) {
  if (terminal_ && !last) {
    const int full = static_cast<int>(share * bar_width);
    line += "[" + std::string(full, '#') + std::string(bar_width - full, '.') + "]";
  }
  line += tail;

  if (!terminal_) {
    std::fprintf(stderr, "%s\n", line.c_str());
  } else {
    clear();
    const auto width = static_cast<std::size_t>(terminal_width() - 1);
    std::fputs(line.substr(0, width).c_str(), stderr);
    if (last) std::fputc('\n', stderr);
    drawn_ = !last;
  }
  std::fflush(stderr);
}

}  // namespace trackbed::apps
