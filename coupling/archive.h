// Named arrays to and from an HDF5 file: what checkpoints and stored packings are made of.
// One visiting function per struct serves writing and reading:
//   template <class A> void visit(A& archive, const std::string& at, Bodies& b)
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "dem/types.h"

namespace trackbed::coupling {

/// Writes `path` aside and renames it in commit(), so that an older file stays whole until the new
/// one is. Throws RunError (disk full, folder gone) naming the file.
class ArchiveWriter {
 public:
  static constexpr bool reading = false;
  explicit ArchiveWriter(const std::string& path);
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;
  void commit();

  void operator()(const std::string& name, double&);
  void operator()(const std::string& name, int&);
  void operator()(const std::string& name, std::uint64_t&);
  void operator()(const std::string& name, std::string&);
  void operator()(const std::string& name, std::vector<double>&);
  void operator()(const std::string& name, std::vector<int>&);
  void operator()(const std::string& name, std::vector<std::uint8_t>&);
  void operator()(const std::string& name, std::vector<dem::Vec3>&);
  void operator()(const std::string& name, std::vector<dem::Quat>&);

 private:
  std::string path_, aside_;
  std::int64_t file_ = -1;
};

/// Reads what an ArchiveWriter wrote. Throws InputError naming the file and the array when the
/// file is missing, truncated, or of another kind.
class ArchiveReader {
 public:
  static constexpr bool reading = true;
  explicit ArchiveReader(const std::string& path);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  void operator()(const std::string& name, double&);
  void operator()(const std::string& name, int&);
  void operator()(const std::string& name, std::uint64_t&);
  void operator()(const std::string& name, std::string&);
  void operator()(const std::string& name, std::vector<double>&);
  void operator()(const std::string& name, std::vector<int>&);
  void operator()(const std::string& name, std::vector<std::uint8_t>&);
  void operator()(const std::string& name, std::vector<dem::Vec3>&);
  void operator()(const std::string& name, std::vector<dem::Quat>&);

 private:
  std::string path_;
  std::int64_t file_ = -1;
};

}  // namespace trackbed::coupling
