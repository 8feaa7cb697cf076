#include "dem/grading/curve.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"

namespace trackbed::dem {
namespace {

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}
std::string mm(double metres) { return text(1000 * metres) + " mm"; }

const std::vector<double> standard_mm = {0.5, 1,  2,  4,    5.6, 8,  11.2, 12.5,
                                         14,  16, 20, 22.4, 25,  28, 31.5, 35.5,
                                         40,  45, 50, 56,   63,  80, 100,  125};

}  // namespace

void validate(const SieveCurve& c) {
  const std::string who = "sieve curve '" + c.name + "': ";
  const size_t n = c.sieve.size();
  if (n == 0) throw InputError(who + "has no sieves; at least one is needed");
  if (c.passing.size() != n)
    throw InputError(who + std::to_string(c.passing.size()) + " percentages for " +
                     std::to_string(n) + " sieves; one per sieve is needed");
  for (size_t i = 0; i < n; ++i) {
    if (!(c.sieve[i] > 0) || !std::isfinite(c.sieve[i]))
      throw InputError(who + "sieve " + std::to_string(i + 1) + " is " + mm(c.sieve[i]) +
                       "; sieves must be positive");
    if (i > 0 && !(c.sieve[i] > c.sieve[i - 1]))
      throw InputError(who + "sieve " + mm(c.sieve[i]) + " follows " + mm(c.sieve[i - 1]) +
                       "; sieves must ascend");
    if (!(c.passing[i] >= 0 && c.passing[i] <= 100))
      throw InputError(who + text(c.passing[i]) + " % passing at " + mm(c.sieve[i]) +
                       "; 0 to 100 is allowed");
    if (i > 0 && c.passing[i] < c.passing[i - 1])
      throw InputError(who + "passing falls from " + text(c.passing[i - 1]) + " % to " +
                       text(c.passing[i]) + " % at " + mm(c.sieve[i]) +
                       "; it must not decrease with the sieve");
  }
  if (c.band_min.size() != c.band_max.size() || (!c.band_min.empty() && c.band_min.size() != n))
    throw InputError(who + "a band needs a lower and an upper limit per sieve");
  for (size_t i = 0; i < c.band_min.size(); ++i)
    if (!(c.band_min[i] <= c.passing[i] && c.passing[i] <= c.band_max[i]))
      throw InputError(who + text(c.passing[i]) + " % at " + mm(c.sieve[i]) +
                       " lies outside its band " + text(c.band_min[i]) + " to " +
                       text(c.band_max[i]) + " %");
  if (c.bottom != 0 && !(c.bottom > 0 && c.bottom < c.sieve.front()))
    throw InputError(who + "least size " + mm(c.bottom) +
                     " must lie between 0 and the first sieve, " + mm(c.sieve.front()));
  if (c.top != 0 && !(c.top > c.sieve.back() && std::isfinite(c.top)))
    throw InputError(who + "largest size " + mm(c.top) + " must lie above the last sieve, " +
                     mm(c.sieve.back()));
}

SieveCurve make_curve(const std::vector<double>& sieve, const std::vector<double>& passing) {
  SieveCurve c;
  c.sieve = sieve;
  c.passing = passing;
  validate(c);
  return c;
}

std::vector<SieveClass> sieve_classes(const SieveCurve& c) {
  validate(c);
  std::vector<SieveClass> classes;
  double low = c.bottom > 0 ? c.bottom : next_sieve_below(c.sieve.front()), below = 0;
  for (size_t i = 0; i < c.sieve.size(); ++i) {
    classes.push_back({low, c.sieve[i], c.passing[i] - below});
    low = c.sieve[i], below = c.passing[i];
  }
  classes.push_back({low, c.top > 0 ? c.top : next_sieve_above(low), 100 - below});
  return classes;
}

std::vector<double> passing_percent(const std::vector<double>& sizes,
                                    const std::vector<double>& volumes,
                                    const std::vector<double>& sieves) {
  if (sizes.size() != volumes.size())
    throw InputError("sieve curve: as many volumes as sizes are needed");
  double total = 0;
  std::vector<double> sum(sieves.size(), 0);
  for (size_t g = 0; g < sizes.size(); ++g) {
    total += volumes[g];
    for (size_t i = 0; i < sieves.size(); ++i)
      if (sizes[g] <= sieves[i]) sum[i] += volumes[g];
  }
  if (!(total > 0)) throw InputError("sieve curve: no grains to sieve");
  for (double& s : sum) s *= 100 / total;
  return sum;
}

int outside_band(const SieveCurve& c, const std::vector<double>& passing, double slack) {
  for (size_t i = 0; i < c.band_min.size() && i < passing.size(); ++i)
    if (!(passing[i] >= c.band_min[i] - slack && passing[i] <= c.band_max[i] + slack))
      return static_cast<int>(i);
  return -1;
}

double next_sieve_above(double size) {
  for (double s : standard_mm)
    if (s > 1000 * size * 1.1) return s / 1000;
  return 1.25 * size;
}

double next_sieve_below(double size) {
  for (size_t k = standard_mm.size(); k-- > 0;)
    if (standard_mm[k] < 1000 * size * 0.9) return standard_mm[k] / 1000;
  return 0.8 * size;
}

double solid_volume(double box_volume, double bulk_density, double grain_density) {
  if (!(box_volume > 0) || !(bulk_density > 0) || !(bulk_density <= grain_density))
    throw InputError("solid volume: needs a positive box and 0 < bulk density <= grain density");
  return bulk_density / grain_density * box_volume;
}

}  // namespace trackbed::dem
