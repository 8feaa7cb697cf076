// Ctrl-C and SIGTERM ask for a stop; the loop looks at the flag between steps, writes a checkpoint
// and ends. A second Ctrl-C ends the program at once.
#pragma once

namespace trackbed::apps {

/// From now on SIGINT and SIGTERM set the flag.
void catch_stop_signals();

/// True once a signal has come. Cheap enough for every step.
bool stop_requested();

/// The signal that came, 0 if none: the exit code of a stopped run is 128 + it by custom.
int stop_signal();

}  // namespace trackbed::apps
