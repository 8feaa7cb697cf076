// The folder a run writes to: made, locked against a second run, and never taken over silently.
#pragma once
#include <string>
#include <vector>

namespace trackbed::apps {

/// keep: a folder of several runs that knows itself which of them are finished.
enum class EarlierRun { refuse, overwrite, resume, keep };

class OutputFolder {
 public:
  /// Makes the folder if it is missing and locks it until destruction. Call it after the scene has
  /// been read and checked, before anything is computed. Throws InputError:
  /// - it cannot be made or written to, or another run is writing to it;
  /// - refuse: it holds a run; resume: it holds no checkpoint.
  /// overwrite removes files of the names that an earlier run may have written, no others.
  OutputFolder(const std::string& folder, EarlierRun mode);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

  /// Does the folder hold (part of) a run?
  static bool holds_run(const std::string& folder);

 private:
  std::string path_;
  int lock_ = -1;
};

/// What to type to go on with a run that was stopped: the command and all that its scene needs.
std::string resume_command(const std::string& command, const std::string& scene,
                           const std::string& folder, const std::vector<std::string>& set);

/// The mode that --resume and --overwrite ask for; both together throw InputError.
EarlierRun earlier_run(bool resume, bool overwrite);

}  // namespace trackbed::apps
