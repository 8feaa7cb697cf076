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

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

// "stem0012.vtu" with the stem and the ending.
bool is_numbered(const std::string& name, const std::string& stem, const std::string& end) {
  return starts_with(name, stem) && ends_with(name, end) &&
         name.size() > stem.size() + end.size() &&
         is_number(name.substr(stem.size(), name.size() - stem.size() - end.size()));
}

// What a run, a packing, a comparison, a cost study or a report writes; tests hold a whole run and
// its report against this list.
bool written_by_a_run(std::string name) {
  if (ends_with(name, ".part")) name.resize(name.size() - 5);  // of a run that was cut off
  for (const char* file : {"cycles.csv",     "compaction.csv",
                           "history.csv",    "energy.csv",
                           "gradation.csv",  "grains.csv",
                           "timing.csv",     "summary.csv",
                           "effects.csv",    "library.csv",
                           "classes.csv",    "porosity.csv",
                           "sections.csv",   "friction_path.csv",
                           "zones.csv",      "pressure.csv",
                           "moment.csv",     "rail_seats.csv",
                           "push.csv",       "subgrade_pressure.csv",
                           "strength.csv",   "subgrade_pressure_profile.csv",
                           "triaxial.csv",   "direct_shear.csv",
                           "repose.csv",     "scene.resolved.prm",
                           "checkpoint.h5",  "test_bed.h5",
                           "snapshots.h5",   "snapshots.xdmf",
                           "packing.off",    "packing.vtu",
                           "packing.csv",    "offender.prm",
                           "offender.csv",   "report.html",
                           "compare.csv",    "compare.html",
                           "runs.csv",       "cost.csv",
                           "cost.html",      "knobs.csv",
                           "tolerance.csv",  "recommended.prm",
                           "recommended.txt"})
    if (name == file) return true;
  for (const char* picture :
       {"bed",      "chains",        "compaction", "direct_shear", "energy",
        "forces",   "friction_path", "gradation",  "history",      "loops",
        "mohr",     "moment",        "porosity",   "pressure",     "repose",
        "sections", "settlement",    "stiffness",  "structures",   "subgrade_pressure",
        "timing",   "triaxial"})
    if (name == std::string(picture) + ".png") return true;
  for (const char* stem : {"compare_", "cost_"})
    if (starts_with(name, stem) && ends_with(name, ".png")) return true;
  for (const char* structure : {"structure_sleeper", "structure_subgrade"})
    if (name == std::string(structure) + ".pvd" || name == std::string(structure) + ".vtu" ||
        is_numbered(name, std::string(structure) + "_", ".vtu"))
      return true;
  return is_numbered(name, "path_", ".h5");
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

std::string resume_command(const std::string& command, const std::string& scene,
                           const std::string& folder, const std::vector<std::string>& set) {
  std::string text = "trackbed " + command + " " + scene + " --output " + folder + " --resume";
  for (const std::string& change : set) text += " --set '" + change + "'";
  return text;
}

EarlierRun earlier_run(bool resume, bool overwrite) {
  if (resume && overwrite)
    throw InputError("--resume and --overwrite exclude each other: go on, or start again");
  return resume ? EarlierRun::resume : overwrite ? EarlierRun::overwrite : EarlierRun::refuse;
}

}  // namespace trackbed::apps
