#include "apps/trackbed/plot_script.h"

#include <spawn.h>
#include <sys/wait.h>

#include <filesystem>

#include "base/error.h"

extern char** environ;

namespace trackbed::apps {

int run_plot_script(const std::string& script, const std::string& folder) {
  // Debian's interpreter: its matplotlib and h5py are there whatever comes first on PATH.
  const std::string python = "/usr/bin/python3", file = std::string(TRACKBED_PLOTS) + "/" + script;
  if (!std::filesystem::exists(file)) throw RunError(file + ": is missing");
  std::string arguments[] = {python, file, folder};
  char* list[] = {arguments[0].data(), arguments[1].data(), arguments[2].data(), nullptr};
  pid_t child = 0;
  if (::posix_spawn(&child, python.c_str(), nullptr, nullptr, list, environ) != 0)
    throw RunError(python +
                   ": cannot be started; the report needs python3 with "
                   "python3-matplotlib and python3-h5py");
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFEXITED(status)) throw RunError("the report's script was stopped by a signal");
  return WEXITSTATUS(status);
}

}  // namespace trackbed::apps
