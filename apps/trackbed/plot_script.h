// Running the Python scripts of apps/plots.
#pragma once
#include <string>

namespace trackbed::apps {

/// Runs a script on a folder with Debian's own interpreter; returns its exit code. Throws RunError
/// when it cannot be started.
int run_plot_script(const std::string& script, const std::string& folder);

}  // namespace trackbed::apps
