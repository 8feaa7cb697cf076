#include "apps/trackbed/cost/subprocess.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

extern char** environ;

namespace trackbed::apps {

pid_t start_self(const std::vector<std::string>& arguments, const std::string& log) {
  std::vector<std::string> words{"trackbed"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> list;
  for (auto& word : words) list.push_back(word.data());
  list.push_back(nullptr);

  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, 0);

  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, "/proc/self/exe", &files, &attributes, list.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  if (failed != 0) throw RunError(log + ": a run of the study cannot be started");
  return child;
}

std::optional<Ended> ended(pid_t child) {
  int status = 0;
  rusage used{};
  if (::wait4(child, &status, WNOHANG, &used) != child) return std::nullopt;
  const auto seconds = [](const timeval& t) { return t.tv_sec + 1e-6 * t.tv_usec; };
  return Ended{WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
               seconds(used.ru_utime) + seconds(used.ru_stime)};
}

void stop(pid_t child) { ::kill(child, SIGTERM); }

}  // namespace trackbed::apps
