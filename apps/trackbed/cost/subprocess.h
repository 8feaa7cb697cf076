// Runs of this same program as processes of their own: what fails takes nothing with it, and each
// one's processor time is known.
#pragma once
#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace trackbed::apps {

/// Starts this program with these arguments (without its name) in a process group of its own, so
/// that Ctrl-C reaches it once, from stop(); its two outputs go to `log`. Throws RunError.
pid_t start_self(const std::vector<std::string>& arguments, const std::string& log);

struct Ended {
  int code = 0;            ///< exit code; 128 + n when signal n ended it
  double cpu_seconds = 0;  ///< of all its threads
};

/// Whether a process has ended; does not wait.
std::optional<Ended> ended(pid_t);

/// Asks a process to write its checkpoint and end (SIGTERM).
void stop(pid_t);

}  // namespace trackbed::apps
