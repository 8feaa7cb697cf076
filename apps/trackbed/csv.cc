#include "apps/trackbed/csv.h"

#include <charconv>
#include <cmath>
#include <filesystem>

#include "apps/trackbed/files.h"
#include "base/error.h"

namespace trackbed::apps {
namespace {

constexpr std::size_t buffer_size = 1 << 16;  // [bytes]

std::string header_line(const std::vector<std::string>& columns) {
  std::string line;
  for (const auto& column : columns) line += (line.empty() ? "" : ",") + column;
  return line + "\n";
}

}  // namespace

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

CsvCell::CsvCell(double value) : text(shortest(value)), finite(std::isfinite(value)) {}

CsvCell::CsvCell(const std::string& value) : text(value) {
  if (value.find_first_of(",\"\n") == std::string::npos) return;
  text = "\"";
  for (char c : value) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  text += '"';
}

CsvWriter::CsvWriter(const std::string& file, std::vector<std::string> columns)
    : file_(file), columns_(std::move(columns)), out_(file, std::ios::binary | std::ios::trunc) {
  buffer_ = header_line(columns_);
  flush();
}

CsvWriter CsvWriter::resume(const std::string& file, std::vector<std::string> columns,
                            std::uint64_t rows) {
  const std::string text = read_text(file);
  const std::string header = header_line(columns);
  if (text.compare(0, header.size(), header) != 0)
    throw InputError(file + ": its columns are not those of this version, so it cannot be resumed");
  std::size_t end = header.size();
  for (std::uint64_t row = 0; row < rows; ++row) {
    const auto newline = text.find('\n', end);
    if (newline == std::string::npos)
      throw InputError(file + ": has " + std::to_string(row) + " rows, the checkpoint counts " +
                       std::to_string(rows));
    end = newline + 1;
  }
  std::error_code error;
  std::filesystem::resize_file(file, end, error);
  if (error) throw InputError(file + ": cannot be written (" + error.message() + ")");
  CsvWriter writer;
  writer.file_ = file;
  writer.columns_ = std::move(columns);
  writer.rows_ = rows;
  writer.out_.open(file, std::ios::binary | std::ios::app);
  writer.flush();
  return writer;
}

CsvWriter::~CsvWriter() {
  try {
    if (out_.is_open()) flush();
  } catch (const RunError&) {
    // Reported by whoever called flush(); a destructor has nobody to tell.
  }
}

void CsvWriter::row(const std::vector<CsvCell>& cells) {
  if (cells.size() != columns_.size())
    throw RunError(file_ + ": a row of " + std::to_string(cells.size()) + " cells for " +
                   std::to_string(columns_.size()) + " columns");
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].finite)
      throw RunError(file_ + ": " + columns_[i] + " of row " + std::to_string(rows_ + 1) + " is " +
                     cells[i].text + ", the run has gone wrong before it");
    if (i > 0) line += ',';
    line += cells[i].text;
  }
  buffer_ += line + '\n';
  ++rows_;
  if (buffer_.size() > buffer_size) flush();
}

void CsvWriter::flush() {
  out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  out_.flush();
  if (!out_) throw RunError(file_ + ": cannot be written (disk full or folder gone?)");
  buffer_.clear();
}

}  // namespace trackbed::apps
