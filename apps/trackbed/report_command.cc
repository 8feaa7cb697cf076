// `trackbed report`: the pages and pictures are made by the Python scripts in apps/plots.
#include <unistd.h>

#include <filesystem>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "apps/trackbed/plot_script.h"
#include "base/error.h"

namespace trackbed::apps {

int report_command(const ReportOptions& options) {
  if (!std::filesystem::is_directory(options.folder))
    throw InputError(options.folder + ": no such folder");
  if (!OutputFolder::holds_run(options.folder))
    throw InputError(options.folder + ": holds no run (history.csv, cycles.csv, ... are missing)");
  if (::access(options.folder.c_str(), W_OK) != 0)
    throw InputError(options.folder + ": cannot be written to");
  return run_plot_script("report.py", options.folder);
}

}  // namespace trackbed::apps
