#include "fem/sparse.h"

#include <algorithm>

namespace trackbed::fem {

int Pattern::place(int row, int col) const {
  const auto first = column.begin() + start[row], last = column.begin() + start[row + 1];
  const auto found = std::lower_bound(first, last, col);
  return found != last && *found == col ? static_cast<int>(found - column.begin()) : -1;
}

Pattern make_pattern(int rows, const std::vector<std::vector<int>>& groups) {
  std::vector<std::vector<int>> columns(rows);
  for (const auto& group : groups)
    for (int i : group)
      if (i >= 0)
        for (int j : group)
          if (j >= 0) columns[i].push_back(j);
  Pattern p;
  p.start.reserve(rows + 1);
  p.start.push_back(0);
  for (auto& row : columns) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    p.column.insert(p.column.end(), row.begin(), row.end());
    p.start.push_back(static_cast<int>(p.column.size()));
    std::vector<int>().swap(row);
  }
  return p;
}

void multiply(const Pattern& p, const std::vector<double>& A, const std::vector<double>& x,
              std::vector<double>& y) {
  y.resize(p.rows());
  for (int r = 0; r < p.rows(); ++r) {
    double sum = 0;
    for (int e = p.start[r]; e < p.start[r + 1]; ++e) sum += A[e] * x[p.column[e]];
    y[r] = sum;
  }
}

double product(const Pattern& p, const std::vector<double>& A, const std::vector<double>& x,
               const std::vector<double>& y) {
  double total = 0;
  for (int r = 0; r < p.rows(); ++r) {
    double sum = 0;
    for (int e = p.start[r]; e < p.start[r + 1]; ++e) sum += A[e] * y[p.column[e]];
    total += x[r] * sum;
  }
  return total;
}

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

void subtract_products(const Pattern& p, const std::vector<double>& M, const std::vector<double>& m,
                       const std::vector<double>& K, const std::vector<double>& k,
                       std::vector<double>& r) {
  const int* column = p.column.data();
  const double *Mv = M.data(), *Kv = K.data(), *mv = m.data(), *kv = k.data();
  for (int row = 0; row < p.rows(); ++row) {
    double a = 0, b = 0;
    for (int e = p.start[row]; e < p.start[row + 1]; ++e) {
      const int c = column[e];
      a += Mv[e] * mv[c];
      b += Kv[e] * kv[c];
    }
    r[row] -= a + b;
  }
}

void modal_place(const double* shape, int nodes, int modes, const double* q, double* u) {
  for (int row = 0; row < 3 * nodes; ++row) {
    // Four sums side by side: a fixed order that the compiler may put into registers.
    double sum[4] = {0, 0, 0, 0};
    const double* phi = shape + static_cast<std::size_t>(row) * modes;
    int k = 0;
    for (; k + 4 <= modes; k += 4)
      for (int j = 0; j < 4; ++j) sum[j] += phi[k + j] * q[k + j];
    for (; k < modes; ++k) sum[0] += phi[k] * q[k];
    u[row] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

}  // namespace trackbed::fem
