// A CSV file that grows row by row: one header line, numbers in the shortest form that reads back
// to the same double, never a NaN or an infinity.
#pragma once
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

namespace trackbed::apps {

/// One cell of a row. A default Cell is empty: a value that does not exist (yet).
struct CsvCell {
  std::string text;
  bool finite = true;

  CsvCell() = default;
  CsvCell(double value);
  CsvCell(const std::string& value);
  CsvCell(const char* value) : CsvCell(std::string(value)) {}
  template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
  CsvCell(Integer value) : text(std::to_string(value)) {}
};

/// The shortest decimal text that reads back to the same double.
std::string shortest(double value);

class CsvWriter {
 public:
  /// A new file with its header. Throws RunError if it cannot be written.
  CsvWriter(const std::string& file, std::vector<std::string> columns);

  /// Goes on after the first `rows` rows of an existing file (a checkpoint's count); what follows
  /// them is cut off. Throws InputError if the file is missing, has another header or fewer rows.
  static CsvWriter resume(const std::string& file, std::vector<std::string> columns,
                          std::uint64_t rows);

  CsvWriter(CsvWriter&&) = default;
  ~CsvWriter();

  /// Appends a row. Throws RunError naming file and column if a number is not finite or the number
  /// of cells is not that of the columns.
  void row(const std::vector<CsvCell>& cells);

  /// Brings all rows to the file. Throws RunError naming the file (full disk).
  void flush();

  std::uint64_t rows() const { return rows_; }

 private:
  CsvWriter() = default;
  std::string file_;
  std::vector<std::string> columns_;
  std::string buffer_;
  std::ofstream out_;
  std::uint64_t rows_ = 0;
};

}  // namespace trackbed::apps
