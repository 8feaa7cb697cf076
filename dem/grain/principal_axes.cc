#include "dem/grain/principal_axes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace trackbed::dem {

Mat3 principal_axes(const Mat3& inertia) {
  const double tiny = 1e-13 * inertia.diagonal().maxCoeff();
  bool diagonal = true;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j && std::abs(inertia(i, j)) > tiny) diagonal = false;
  Mat3 axes = Mat3::Identity();
  if (!diagonal) {
    axes = Eigen::SelfAdjointEigenSolver<Mat3>(inertia).eigenvectors();  // ascending
  } else {
    std::array<int, 3> order = {0, 1, 2};
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return inertia(a, a) < inertia(b, b) - tiny; });
    for (int i = 0; i < 3; ++i) axes.col(i) = Mat3::Identity().col(order[i]);
  }
  for (int i = 0; i < 2; ++i) {  // fixed signs: the largest component is positive
    int largest = 0;
    axes.col(i).cwiseAbs().maxCoeff(&largest);
    if (axes(largest, i) < 0) axes.col(i) *= -1;
  }
  axes.col(2) = axes.col(0).cross(axes.col(1)).normalized();
  return axes;
}

}  // namespace trackbed::dem
