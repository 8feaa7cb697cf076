#include "coupling/archive.h"

#include <hdf5.h>

#include <cstdio>
#include <filesystem>

#include "base/error.h"

namespace trackbed::coupling {
namespace {

static_assert(sizeof(dem::Vec3) == 3 * sizeof(double));
static_assert(sizeof(dem::Quat) == 4 * sizeof(double));

// HDF5 prints its own error stack otherwise; ours are one line.
void quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

void write(hid_t file, const std::string& path, const std::string& name, hid_t type,
           const void* data, hsize_t count) {
  const hid_t links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  const hid_t space = H5Screate_simple(1, &count, nullptr);
  const hid_t set = H5Dcreate2(file, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT);
  const bool good =
      set >= 0 && (count == 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  if (set >= 0) H5Dclose(set);
  H5Sclose(space);
  H5Pclose(links);
  if (!good) throw RunError(path + ": cannot write '" + name + "' (disk full?)");
}

// Calls resize(count) for the destination, then reads into what it returns.
template <class Resize>
void read(hid_t file, const std::string& path, const std::string& name, hid_t type, Resize resize) {
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  if (set < 0) throw InputError(path + ": no array '" + name + "' (truncated or of another kind)");
  const hid_t space = H5Dget_space(set);
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  H5Sclose(space);
  void* data = count >= 0 ? resize(static_cast<std::size_t>(count)) : nullptr;
  const bool good =
      count == 0 || (data && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  H5Dclose(set);
  if (!good) throw InputError(path + ": array '" + name + "' cannot be read (truncated?)");
}

template <class T>
void* single(T& value, std::size_t count) {
  return count == 1 ? &value : nullptr;
}

// Null, which is an error, unless the numbers make whole vectors.
template <int size, class T>
void* groups_of(std::vector<T>& v, std::size_t count) {
  v.resize(count / size);
  return count % size == 0 ? v.data() : nullptr;
}

}  // namespace

ArchiveWriter::ArchiveWriter(const std::string& path) : path_(path), aside_(path + ".part") {
  quiet();
  file_ = H5Fcreate(aside_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file_ < 0) throw RunError(path + ": cannot be written");
}

ArchiveWriter::~ArchiveWriter() {
  if (file_ < 0) return;
  H5Fclose(file_);
  std::remove(aside_.c_str());
}

void ArchiveWriter::commit() {
  const bool good = H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0 && H5Fclose(file_) >= 0;
  file_ = -1;
  std::error_code failed;
  if (good) std::filesystem::rename(aside_, path_, failed);
  if (!good || failed) {
    std::remove(aside_.c_str());
    throw RunError(path_ + ": cannot be written (disk full?)");
  }
}

void ArchiveWriter::operator()(const std::string& n, double& v) {
  write(file_, path_, n, H5T_NATIVE_DOUBLE, &v, 1);
}
void ArchiveWriter::operator()(const std::string& n, int& v) {
  write(file_, path_, n, H5T_NATIVE_INT, &v, 1);
}
void ArchiveWriter::operator()(const std::string& n, std::uint64_t& v) {
  write(file_, path_, n, H5T_NATIVE_UINT64, &v, 1);
}
void ArchiveWriter::operator()(const std::string& n, std::string& v) {
  write(file_, path_, n, H5T_NATIVE_UINT8, v.data(), v.size());
}
void ArchiveWriter::operator()(const std::string& n, std::vector<double>& v) {
  write(file_, path_, n, H5T_NATIVE_DOUBLE, v.data(), v.size());
}
void ArchiveWriter::operator()(const std::string& n, std::vector<int>& v) {
  write(file_, path_, n, H5T_NATIVE_INT, v.data(), v.size());
}
void ArchiveWriter::operator()(const std::string& n, std::vector<std::uint8_t>& v) {
  write(file_, path_, n, H5T_NATIVE_UINT8, v.data(), v.size());
}
void ArchiveWriter::operator()(const std::string& n, std::vector<dem::Vec3>& v) {
  write(file_, path_, n, H5T_NATIVE_DOUBLE, v.data(), 3 * v.size());
}
void ArchiveWriter::operator()(const std::string& n, std::vector<dem::Quat>& v) {
  write(file_, path_, n, H5T_NATIVE_DOUBLE, v.data(), 4 * v.size());
}

ArchiveReader::ArchiveReader(const std::string& path) : path_(path) {
  quiet();
  if (!std::filesystem::exists(path)) throw InputError(path + ": no such file");
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) throw InputError(path + ": not a whole HDF5 file (truncated?)");
}

ArchiveReader::~ArchiveReader() { H5Fclose(file_); }

void ArchiveReader::operator()(const std::string& n, double& v) {
  read(file_, path_, n, H5T_NATIVE_DOUBLE, [&](std::size_t c) { return single(v, c); });
}
void ArchiveReader::operator()(const std::string& n, int& v) {
  read(file_, path_, n, H5T_NATIVE_INT, [&](std::size_t c) { return single(v, c); });
}
void ArchiveReader::operator()(const std::string& n, std::uint64_t& v) {
  read(file_, path_, n, H5T_NATIVE_UINT64, [&](std::size_t c) { return single(v, c); });
}
void ArchiveReader::operator()(const std::string& n, std::string& v) {
  read(file_, path_, n, H5T_NATIVE_UINT8, [&](std::size_t c) { return v.resize(c), v.data(); });
}
void ArchiveReader::operator()(const std::string& n, std::vector<double>& v) {
  read(file_, path_, n, H5T_NATIVE_DOUBLE, [&](std::size_t c) { return v.resize(c), v.data(); });
}
void ArchiveReader::operator()(const std::string& n, std::vector<int>& v) {
  read(file_, path_, n, H5T_NATIVE_INT, [&](std::size_t c) { return v.resize(c), v.data(); });
}
void ArchiveReader::operator()(const std::string& n, std::vector<std::uint8_t>& v) {
  read(file_, path_, n, H5T_NATIVE_UINT8, [&](std::size_t c) { return v.resize(c), v.data(); });
}
void ArchiveReader::operator()(const std::string& n, std::vector<dem::Vec3>& v) {
  read(file_, path_, n, H5T_NATIVE_DOUBLE, [&](std::size_t c) { return groups_of<3>(v, c); });
}
void ArchiveReader::operator()(const std::string& n, std::vector<dem::Quat>& v) {
  read(file_, path_, n, H5T_NATIVE_DOUBLE, [&](std::size_t c) { return groups_of<4>(v, c); });
}

}  // namespace trackbed::coupling
