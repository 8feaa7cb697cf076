// `trackbed report`: the pages and pictures are made by the Python scripts in apps/plots.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/output_folder.h"
#include "base/error.h"

extern char** environ;

namespace trackbed::apps {
namespace {

/// Debian's own interpreter: its matplotlib and h5py are there whatever comes first on PATH.
constexpr char python[] = "/usr/bin/python3";
constexpr char script[] = TRACKBED_PLOTS "/report.py";

}  // namespace

int report_command(const ReportOptions& options) {
  if (!std::filesystem::is_directory(options.folder))
    throw InputError(options.folder + ": no such folder");
  if (!OutputFolder::holds_run(options.folder))
    throw InputError(options.folder + ": holds no run (history.csv, cycles.csv, ... are missing)");
  if (::access(options.folder.c_str(), W_OK) != 0)
    throw InputError(options.folder + ": cannot be written to");
  if (!std::filesystem::exists(script)) throw RunError(std::string(script) + ": is missing");

  std::string arguments[] = {python, script, options.folder};
  char* list[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(), nullptr};
  pid_t child = 0;
  if (::posix_spawn(&child, python, nullptr, nullptr, list, environ) != 0)
    throw RunError(std::string(python) +
                   ": cannot be started; the report needs python3 with "
                   "python3-matplotlib and python3-h5py");
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFEXITED(status)) throw RunError("the report's script was stopped by a signal");
  return WEXITSTATUS(status);
}

}  // namespace trackbed::apps
