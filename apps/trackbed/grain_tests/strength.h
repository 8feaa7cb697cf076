// From curves and profiles to friction angles: least squares, Mohr-Coulomb, peak and residual.
// Plain functions of numbers.
#pragma once
#include <limits>
#include <vector>

namespace trackbed::apps {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// y = intercept + slope x by least squares. Standard errors from the residuals with n - 2 degrees
/// of freedom: unknown for two points.
struct Line {
  double slope = 0, intercept = 0;
  double slope_error = kUnknown, intercept_error = kUnknown;
  int points = 0;
};
/// Throws InputError for fewer than two different x.
Line fit_line(const std::vector<double>& x, const std::vector<double>& y);

/// Half width of the 95 % confidence interval of an estimate over its standard error: Student's t
/// with these degrees of freedom (n - 2 of a line, n - 1 of a mean); unknown for none.
double confidence_factor(int freedom);

/// A value and its standard error; unknown where there is none.
struct Estimate {
  double value = kUnknown, error = kUnknown;
};

/// Friction angle [rad] and apparent cohesion [Pa] of tau = c + sigma tan(phi).
struct MohrCoulomb {
  Estimate angle, cohesion;
  int points = 0;
};

/// From normal and shear stresses on one plane [Pa].
MohrCoulomb fit_shear(const std::vector<double>& normal, const std::vector<double>& shear);

/// From principal stresses [Pa], by the line (s1-s3)/2 = (s1+s3)/2 sin(phi) + c cos(phi) through
/// the tops of Mohr's circles.
MohrCoulomb fit_triaxial(const std::vector<double>& s1, const std::vector<double>& s3);

/// asin of (s1-s3)/(s1+s3) [rad]: of one circle, without cohesion.
double principal_angle(double s1, double s3);

/// Where a curve stands highest: the middle of the `window` rows in succession whose mean is
/// largest (of all rows where there are fewer). Returns the first of them.
int peak_rows(const std::vector<double>& values, int window);

/// Mean of a range of values and the standard error of that mean as if they were independent.
Estimate mean_of(const std::vector<double>& values, int first, int count);

}  // namespace trackbed::apps
