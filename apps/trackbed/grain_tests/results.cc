// Curves and strengths of a test as files and lines to read.
#include <cmath>
#include <cstdio>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/grain_tests/grain_tests.h"
#include "apps/trackbed/grain_tests/profile.h"
#include "apps/trackbed/grain_tests/strength.h"
#include "apps/trackbed/grain_tests/walls.h"

namespace trackbed::apps {
namespace {

constexpr int kPeakRows = 5;  // whose mean is a peak
constexpr double kDegree = M_PI / 180;

// A row of strength.csv. Stresses [Pa], angles [rad].
struct Strength {
  std::string state;         // "peak" | "residual" | "repose", or a fit over all specimens
  double stress = kUnknown;  // normal or confining
  double ratio = kUnknown;   // shear over normal, or (s1-s3)/(s1+s3)
  Estimate angle, cohesion;
  int freedom = 0;             // degrees, of the errors
  double held = kUnknown;      // largest deviation of a held stress, share
  double position = kUnknown;  // mean shear displacement [m] or axial strain of its rows
  double porosity = kUnknown;  // in the first row
  bool at_end = false;         // a peak that the curve's last rows make: it may rise further
};

Strength of_fit(const char* state, const MohrCoulomb& m) {
  Strength s;
  s.state = state, s.angle = m.angle, s.cohesion = m.cohesion, s.freedom = m.points - 2;
  return s;
}

// One specimen: columns of its curve, each a row's mean. A curve that is not whole yet has no
// strength.
struct Curve {
  double target = 0;
  bool whole = false;
  std::vector<std::vector<double>> column;
  int rows() const { return column.empty() ? 0 : static_cast<int>(column[0].size()); }
};

std::vector<Curve> curves_of(const Run& run, int columns) {
  const std::vector<double>& all = run.test.rows;
  std::vector<Curve> curves(run.scene.test.stresses.size());
  for (std::size_t k = 0; k < curves.size(); ++k) {
    curves[k].target = run.scene.test.stresses[k];
    curves[k].column.resize(columns);
  }
  for (std::size_t at = 0; at + columns < all.size(); at += columns + 1)
    for (int c = 0; c < columns; ++c)
      curves[static_cast<int>(all[at])].column[c].push_back(all[at + 1 + c]);
  for (Curve& c : curves) c.whole = c.rows() == run.scene.test.samples;
  return curves;
}

CsvCell known(double value) { return std::isfinite(value) ? CsvCell(value) : CsvCell(); }

void write_strength(const Run& run, const std::vector<Strength>& rows, const std::string& file) {
  CsvWriter csv(file,
                {"test", "state", "stress_Pa", "ratio", "friction_angle_deg", "angle_error_deg",
                 "angle_ci95_deg", "cohesion_Pa", "cohesion_error_Pa", "cohesion_ci95_Pa",
                 "inertial_number", "held_within", "position", "start_porosity"});
  const double inertial = inertial_number(run.scene, run.test.size);
  for (const Strength& s : rows) {
    const double factor = confidence_factor(s.freedom);
    csv.row({run.scene.test.type, s.state, known(s.stress), known(s.ratio),
             known(s.angle.value / kDegree), known(s.angle.error / kDegree),
             known(factor * s.angle.error / kDegree), known(s.cohesion.value),
             known(s.cohesion.error), known(factor * s.cohesion.error),
             inertial > 0 ? CsvCell(inertial) : CsvCell(), known(s.held), known(s.position),
             known(s.porosity)});
  }
  csv.flush();
}

std::string line_of(const Strength& s) {
  char text[240];
  int n = std::snprintf(text, sizeof text, "%s", s.state.c_str());
  const auto add = [&](const char* format, double a, double b) {
    if (std::isfinite(a)) n += std::snprintf(text + n, sizeof text - n, format, a, b);
  };
  add(" at %.4g kPa", 1e-3 * s.stress, 0);
  add(", ratio %.3f", s.ratio, 0);
  add(", friction angle %.1f deg", s.angle.value / kDegree, 0);
  add(" (standard error %.1f)", s.angle.error / kDegree, 0);
  add(", apparent cohesion %.3g kPa", 1e-3 * s.cohesion.value, 0);
  add(" (standard error %.2g)", 1e-3 * s.cohesion.error, 0);
  return text;
}

// Mean of a column over the peak's rows and over the residual ones.
struct Part {
  std::string state;
  int first, count;
};

std::vector<Part> parts_of(const std::vector<double>& ratio, double residual_share) {
  const int n = static_cast<int>(ratio.size());
  const int last = std::max(1, static_cast<int>(residual_share * n + 0.5));
  return {{"peak", peak_rows(ratio, kPeakRows), std::min(kPeakRows, n)},
          {"residual", n - last, last}};
}

double mean(const std::vector<double>& v, const Part& p) {
  return mean_of(v, p.first, p.count).value;
}

bool ends(const Part& p, int rows) { return p.state == "peak" && p.first + p.count > 0.95 * rows; }

// Of these rows of a specimen's curve, but for ratio, angle and how well its stress was held.
Strength strength_of(const Part& p, const Curve& c, int position, int porosity) {
  Strength s;
  s.state = p.state, s.stress = c.target;
  s.position = mean(c.column[position], p), s.at_end = ends(p, c.rows());
  s.porosity = c.column[porosity].front();
  return s;
}

double furthest(const std::vector<double>& v, double target) {
  double most = 0;
  for (const double x : v) most = std::max(most, std::abs(x / target - 1));
  return most;
}

std::vector<Strength> direct_shear(const Run& run, const std::string& folder) {
  enum { kTime, kTravel, kShear, kNormal, kDilation, kPorosity, kColumns };
  const double area = run.layout.area;
  std::vector<Strength> found;
  CsvWriter csv(folder + "/direct_shear.csv",
                {"stress_Pa", "time_s", "displacement_m", "shear_force_N", "shear_stress_Pa",
                 "normal_stress_Pa", "stress_ratio", "dilation_m", "porosity"});
  std::vector<double> normal[2], shear[2];  // at peak, residual
  for (const Curve& c : curves_of(run, kColumns)) {
    if (c.rows() == 0) continue;
    std::vector<double> ratio;
    for (int k = 0; k < c.rows(); ++k) {
      const double t = c.column[kShear][k], n = c.column[kNormal][k];
      ratio.push_back(t / n);
      csv.row({c.target, c.column[kTime][k], c.column[kTravel][k], t, t / area, n / area, t / n,
               c.column[kDilation][k], c.column[kPorosity][k]});
    }
    if (!c.whole) continue;
    int which = 0;
    for (const Part& p : parts_of(ratio, run.scene.test.residual_share)) {
      const double n = mean(c.column[kNormal], p) / area, t = mean(c.column[kShear], p) / area;
      normal[which].push_back(n), shear[which].push_back(t);
      ++which;
      Strength s = strength_of(p, c, kTravel, kPorosity);
      s.ratio = t / n, s.angle.value = std::atan(t / n);
      s.held = furthest(c.column[kNormal], c.target * area);
      found.push_back(s);
    }
  }
  csv.flush();
  for (int which = 0; which < 2; ++which) {
    if (normal[which].size() < 2) continue;
    const MohrCoulomb m = fit_shear(normal[which], shear[which]);
    found.push_back(of_fit(which == 0 ? "peak fit" : "residual fit", m));
  }
  return found;
}

std::vector<Strength> triaxial(const Run& run, const std::string& folder) {
  enum { kTime, kStrain, kAxial, kSideX, kSideY, kVolume, kPorosity, kColumns };
  std::vector<Strength> found;
  CsvWriter csv(folder + "/triaxial.csv",
                {"stress_Pa", "time_s", "axial_strain", "sigma1_Pa", "sigma3_Pa", "sigma3_x_Pa",
                 "sigma3_y_Pa", "deviator_Pa", "mean_stress_Pa", "volumetric_strain",
                 "mobilised_angle_deg", "porosity"});
  std::vector<double> major[2], minor[2];
  for (const Curve& c : curves_of(run, kColumns)) {
    if (c.rows() == 0) continue;
    std::vector<double> ratio, least;
    for (int k = 0; k < c.rows(); ++k) {
      const double s1 = c.column[kAxial][k];
      const double sx = c.column[kSideX][k], sy = c.column[kSideY][k], s3 = (sx + sy) / 2;
      least.push_back(s3), ratio.push_back((s1 - s3) / (s1 + s3));
      csv.row({c.target, c.column[kTime][k], c.column[kStrain][k], s1, s3, sx, sy, s1 - s3,
               (s1 + 2 * s3) / 3, c.column[kVolume][k], principal_angle(s1, s3) / kDegree,
               c.column[kPorosity][k]});
    }
    if (!c.whole) continue;
    int which = 0;
    for (const Part& p : parts_of(ratio, run.scene.test.residual_share)) {
      const double s1 = mean(c.column[kAxial], p), s3 = mean(least, p);
      major[which].push_back(s1), minor[which].push_back(s3);
      ++which;
      Strength s = strength_of(p, c, kStrain, kPorosity);
      s.ratio = (s1 - s3) / (s1 + s3), s.angle.value = principal_angle(s1, s3);
      s.held = std::max(furthest(c.column[kSideX], c.target), furthest(c.column[kSideY], c.target));
      found.push_back(s);
    }
  }
  csv.flush();
  for (int which = 0; which < 2; ++which) {
    if (major[which].size() < 2) continue;
    const MohrCoulomb m = fit_triaxial(major[which], minor[which]);
    found.push_back(of_fit(which == 0 ? "peak fit" : "residual fit", m));
  }
  return found;
}

std::vector<Strength> repose(const Run& run, const std::string& folder) {
  const GrainTestState& t = run.test;
  if (t.placed.empty()) return {};  // not begun
  const double end = t.high.x() + run.scene.test.floor_length, across = t.high.y() - t.low.y();
  const int given = run.scene.test.planes;
  const int cuts = given > 0 ? given : std::max(1, static_cast<int>(across / t.size));
  std::vector<dem::CuttingPlane> planes;
  for (int k = 0; k < cuts; ++k) planes.push_back({1, t.low.y() + across * (k + 0.5) / cuts});
  const int slices = std::max(5, static_cast<int>((end - t.low.x()) / (0.5 * t.size)));
  auto profile = heap_profile(dem::placed_grains(run.world.bodies, run.world.shapes),
                              run.layout.period, planes, t.low.x(), end, t.low.z(), slices);
  Strength s;
  s.state = "repose", s.angle = slope_angle(profile), s.freedom = cuts - 1;
  CsvWriter csv(folder + "/repose.csv", {"distance_m", "height_m", "height_deviation_m", "fitted"});
  for (const ProfileSlice& p : profile) {
    const double error = mean_of(p.cuts, 0, cuts).error;
    csv.row({p.distance - t.low.x(), p.height, known(error * std::sqrt(cuts)), p.fitted ? 1 : 0});
  }
  csv.flush();
  if (std::isfinite(s.angle.value)) s.ratio = std::tan(s.angle.value);
  return {s};
}

}  // namespace

std::vector<Stage> grain_test_stages(const Scene& s) {
  if (s.test.type == "direct_shear") return shear_stages(s);
  if (s.test.type == "triaxial") return triaxial_stages(s);
  return repose_stages(s);
}

std::vector<std::string> write_grain_test(const Run& run, const std::string& folder) {
  const GrainTestScene& test = run.scene.test;
  const std::vector<Strength> found = test.type == "direct_shear" ? direct_shear(run, folder)
                                      : test.type == "triaxial"   ? triaxial(run, folder)
                                                                  : repose(run, folder);
  write_strength(run, found, folder + "/strength.csv");
  std::vector<std::string> lines;
  double held = 0;
  for (const Strength& s : found) {
    lines.push_back(test.type + ": " + line_of(s));
    if (s.held > held) held = s.held;
    if (s.at_end)
      lines.push_back(stress_name("the curve at", s.stress) +
                      " is highest at its end: no peak was passed, so what is called residual is "
                      "none; a longer Test/" +
                      (test.type == "triaxial" ? "Largest strain" : "Travel") + " is needed");
    if (s.state == "repose" && !std::isfinite(s.angle.value))
      lines.push_back(
          "no slope of three slices: a longer Container/Length, more grains, or a "
          "longer Test/Floor length is needed");
  }
  const double inertial = inertial_number(run.scene, run.test.size);
  char text[200];
  if (inertial > kQuasiStatic) {
    std::snprintf(text, sizeof text,
                  "not quasi-static: the inertial number is %.2g, over %g; lower Test/%s", inertial,
                  kQuasiStatic, test.type == "triaxial" ? "Strain rate" : "Speed");
    lines.push_back(text);
  }
  if (held > test.tolerance) {
    std::snprintf(text, sizeof text,
                  "a held stress was off by up to %.2g of it in a row (Test/Tolerance = %g): lower "
                  "the speed, or take more grains",
                  held, test.tolerance);
    lines.push_back(text);
  }
  return lines;
}

}  // namespace trackbed::apps
