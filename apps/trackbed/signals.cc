#include "apps/trackbed/signals.h"

#include <csignal>

namespace trackbed::apps {
namespace {

volatile std::sig_atomic_t signal_came = 0;

extern "C" void note_signal(int number) {
  signal_came = number;
  std::signal(number, SIG_DFL);
}

}  // namespace

void catch_stop_signals() {
  signal_came = 0;
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

bool stop_requested() { return signal_came != 0; }

int stop_signal() { return signal_came; }

}  // namespace trackbed::apps
