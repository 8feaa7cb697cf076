#include "apps/trackbed/output_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/error.h"

namespace trackbed::apps {
namespace {

namespace fs = std::filesystem;

constexpr char lock_name[] = ".lock";

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// What a run, a packing, a comparison or a report writes (DESIGN: output of a run).
bool written_by_a_run(const std::string& name) {
  for (const char* file :
       {"cycles.csv",      "compaction.csv",  "history.csv",       "energy.csv",
        "gradation.csv",   "grains.csv",      "timing.csv",        "scene.resolved.prm",
        "snapshots.h5",    "snapshots.xdmf",  "checkpoint.h5",     "report.html",
        "compare.csv",     "compare.html",    "summary.csv",       "cost.csv",
        "cost.html",       "runs.csv",        "knobs.csv",         "tolerance.csv",
        "recommended.prm", "recommended.txt", "porosity.csv",      "sections.csv",
        "library.csv",     "classes.csv",     "friction_path.csv", "zones.csv",
        "packing.off",     "packing.vtu",     "packing.csv"})
    if (name == file || name == file + std::string(".part")) return true;
  return starts_with(name, "structure_") || starts_with(name, "path_") ||
         starts_with(name, "snapshots") || ends_with(name, ".png");
}

}  // namespace

bool OutputFolder::holds_run(const std::string& folder) {
  for (const char* name : {"scene.resolved.prm", "checkpoint.h5", "cycles.csv", "history.csv",
                           "compare.csv", "rigid", "elastic", "runs.csv"})
    if (fs::exists(fs::path(folder) / name)) return true;
  return false;
}

OutputFolder::OutputFolder(const std::string& folder, EarlierRun mode) : path_(folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(folder + ": output folder cannot be made (" +
                     (error ? error.message() : std::string("a file is in its place")) +
                     "); choose another with --output");
  const std::string lock_file = file(lock_name);
  lock_ = ::open(lock_file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0)
    throw InputError(folder + ": output folder cannot be written to (" + std::strerror(errno) +
                     "); choose another with --output");
  try {
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0)
      throw InputError(folder + ": another run is writing to this folder");
    if (mode == EarlierRun::refuse && holds_run(folder))
      throw InputError(
          folder +
          ": holds a run already; go on with --resume, replace it with --overwrite, or "
          "choose another folder with --output");
    if (mode == EarlierRun::resume && !fs::exists(file("checkpoint.h5")))
      throw InputError(folder + ": holds no checkpoint.h5 to resume from");
  } catch (...) {
    ::close(lock_);
    throw;
  }
  if (mode != EarlierRun::overwrite) return;
  std::vector<fs::path> old;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && written_by_a_run(entry.path().filename().string()))
      old.push_back(entry.path());
  for (const auto& path : old) fs::remove(path, error);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove(file(lock_name), ignored);
  ::close(lock_);
}

EarlierRun earlier_run(bool resume, bool overwrite) {
  if (resume && overwrite)
    throw InputError("--resume and --overwrite exclude each other: go on, or start again");
  return resume ? EarlierRun::resume : overwrite ? EarlierRun::overwrite : EarlierRun::refuse;
}

}  // namespace trackbed::apps
