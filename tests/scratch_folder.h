// A folder of a test's own. Tests run side by side, so no two may write one file.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace trackbed {

/// New and empty, in the system's folder for what is temporary; removed with all that is in it.
class ScratchFolder {
 public:
  ScratchFolder() : path_((std::filesystem::temp_directory_path() / "trackbed.XXXXXX").string()) {
    if (!::mkdtemp(path_.data())) throw std::runtime_error(path_ + ": cannot be made");
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Path of a file in it, which need not be there yet.
  std::string file(const std::string& name) const { return path_ + "/" + name; }
  /// Writes it; its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }

 private:
  std::string path_;
};

}  // namespace trackbed
