// Sparse matrices that share one pattern: rows of the unknowns, columns ascending.
#pragma once
#include <vector>

namespace trackbed::fem {

struct Pattern {
  std::vector<int> start, column;  ///< row r: entries [start[r], start[r+1])
  int rows() const { return static_cast<int>(start.size()) - 1; }
  /// Place of (row, column) in a value array; -1 if it is not in the pattern.
  int place(int row, int col) const;
};

/// The pattern in which all unknowns of one group (a cell, a face) meet each other; -1 is skipped.
Pattern make_pattern(int rows, const std::vector<std::vector<int>>& groups);

/// y = A x
void multiply(const Pattern&, const std::vector<double>& A, const std::vector<double>& x,
              std::vector<double>& y);
/// x · A y
double product(const Pattern&, const std::vector<double>& A, const std::vector<double>& x,
               const std::vector<double>& y);
double dot(const std::vector<double>& x, const std::vector<double>& y);

/// r −= M m + K k, in one pass over the pattern.
void subtract_products(const Pattern&, const std::vector<double>& M, const std::vector<double>& m,
                       const std::vector<double>& K, const std::vector<double>& k,
                       std::vector<double>& r);

/// u = Φ q, row by row: `rows` nodes of three directions, `modes` columns (modal_structure.h).
void modal_place(const double* shape, int nodes, int modes, const double* q, double* u);

}  // namespace trackbed::fem
