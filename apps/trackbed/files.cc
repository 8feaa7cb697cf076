#include "apps/trackbed/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"

namespace trackbed::apps {

std::string read_text(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw InputError(file + ": no such file");
  if (std::filesystem::is_directory(status))
    throw InputError(file + ": is a folder, a file is needed");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in || in.bad()) throw InputError(file + ": cannot be read");
  return text.str();
}

std::string aside_name(const std::string& file) { return file + ".part"; }

void rename_into_place(const std::string& file) {
  const std::string part = aside_name(file);
  const int handle = ::open(part.c_str(), O_RDONLY);
  const bool synced = handle >= 0 && ::fsync(handle) == 0;
  const int reason = errno;
  if (handle >= 0) ::close(handle);
  if (!synced)
    throw RunError(file + ": cannot be written to the disk (" + std::strerror(reason) + ")");
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) throw RunError(file + ": cannot be put in place (" + error.message() + ")");
}

void write_aside_then_rename(const std::string& file, const std::string& text) {
  {
    errno = 0;
    std::ofstream out(aside_name(file), std::ios::binary | std::ios::trunc);
    out << text;
    out.flush();
    if (!out) {
      const int reason = errno;
      std::error_code ignored;
      std::filesystem::remove(aside_name(file), ignored);
      throw RunError(file + ": cannot be written (" + std::strerror(reason ? reason : EIO) + ")");
    }
  }
  rename_into_place(file);
}

}  // namespace trackbed::apps
