#include "apps/trackbed/grain_tests/strength.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/error.h"

namespace trackbed::apps {

Line fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
  for (std::size_t k = 0; k < x.size(); ++k) mean_x += x[k] / n, mean_y += y[k] / n;
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  if (!(xx > 0)) throw InputError("a line needs at least two points apart");
  Line line;
  line.points = static_cast<int>(x.size());
  line.slope = xy / xx;
  line.intercept = mean_y - line.slope * mean_x;
  for (std::size_t k = 0; k < x.size(); ++k)
    rest += std::pow(y[k] - line.intercept - line.slope * x[k], 2);
  if (line.points > 2) {
    line.slope_error = std::sqrt(rest / (n - 2) / xx);
    line.intercept_error = line.slope_error * std::sqrt(xx / n + mean_x * mean_x);
  }
  return line;
}

double confidence_factor(int freedom) {
  if (freedom < 1) return kUnknown;
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

MohrCoulomb fit_shear(const std::vector<double>& normal, const std::vector<double>& shear) {
  const Line line = fit_line(normal, shear);
  const double angle = std::atan(line.slope);
  MohrCoulomb m;
  m.points = line.points;
  m.angle = {angle, line.slope_error * std::pow(std::cos(angle), 2)};
  m.cohesion = {line.intercept, line.intercept_error};
  return m;
}

MohrCoulomb fit_triaxial(const std::vector<double>& s1, const std::vector<double>& s3) {
  std::vector<double> middle, radius;
  for (std::size_t k = 0; k < s1.size(); ++k)
    middle.push_back((s1[k] + s3[k]) / 2), radius.push_back((s1[k] - s3[k]) / 2);
  const Line line = fit_line(middle, radius);
  MohrCoulomb m;
  m.points = line.points;
  // Scatter may make the line steeper than any circle's: then there is no angle.
  if (std::abs(line.slope) >= 1) return m;
  const double angle = std::asin(line.slope), cosine = std::cos(angle);
  m.angle = {angle, line.slope_error / cosine};
  m.cohesion = {line.intercept / cosine, line.intercept_error / cosine};
  return m;
}

double principal_angle(double s1, double s3) { return std::asin((s1 - s3) / (s1 + s3)); }

int peak_rows(const std::vector<double>& values, int window) {
  const int n = static_cast<int>(values.size());
  int best = 0;
  double most = -HUGE_VAL;
  for (int first = 0; first + std::min(window, n) <= n; ++first) {
    const double mean = mean_of(values, first, std::min(window, n)).value;
    if (mean > most) most = mean, best = first;
  }
  return best;
}

Estimate mean_of(const std::vector<double>& values, int first, int count) {
  double mean = 0, spread = 0;
  for (int k = first; k < first + count; ++k) mean += values[k] / count;
  for (int k = first; k < first + count; ++k) spread += std::pow(values[k] - mean, 2);
  return {mean, count > 1 ? std::sqrt(spread / (count - 1) / count) : kUnknown};
}

}  // namespace trackbed::apps
