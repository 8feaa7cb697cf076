// `trackbed sieve`: sizes of solids as CSV; a sample's curve against a standard's band.
#include <cstdio>
#include <filesystem>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/csv.h"
#include "base/error.h"
#include "dem/grading/curve.h"
#include "dem/grading/sieve_size.h"
#include "dem/grain/off_io.h"

namespace trackbed::apps {
namespace {

/// Ten digits: more than any solid's coordinates have.
std::string tidy(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

double metres_of(const std::string& unit) { return unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : 1; }

std::vector<dem::SieveMethod> methods_of(const std::string& name) {
  if (name != "all") return {dem::parse_sieve_method(name)};
  std::vector<dem::SieveMethod> methods;
  for (const auto& method : dem::sieve_method_names())
    methods.push_back(dem::parse_sieve_method(method));
  return methods;
}

/// Cumulative curve of the sample against the named one. Columns: method, sieve [m], passing of
/// sample and curve and the curve's band [%].
void print_curve(const dem::SieveCurve& curve, const std::string& method,
                 const std::vector<double>& sizes, const std::vector<double>& volumes) {
  const auto passing = dem::passing_percent(sizes, volumes, curve.sieve);
  for (std::size_t i = 0; i < curve.sieve.size(); ++i) {
    const bool band = !curve.band_min.empty();
    std::printf("%s,%s,%s,%s,%s,%s\n", method.c_str(), shortest(curve.sieve[i]).c_str(),
                tidy(passing[i]).c_str(), shortest(curve.passing[i]).c_str(),
                band ? shortest(curve.band_min[i]).c_str() : "",
                band ? shortest(curve.band_max[i]).c_str() : "");
  }
  const int outside = dem::outside_band(curve, passing);
  if (outside >= 0)
    std::fprintf(stderr, "%s: the sample leaves the band of %s at the sieve of %g mm\n",
                 method.c_str(), curve.name.c_str(), 1e3 * curve.sieve[outside]);
}

}  // namespace

int sieve_command(const SieveOptions& options) {
  const auto methods = methods_of(options.method);
  dem::SieveCurve curve;
  if (!options.curve.empty()) curve = dem::named_curve(options.curve);

  std::vector<dem::Polyhedron> solids;  // all are read before anything is printed
  for (const auto& file : options.grains)
    solids.push_back(dem::read_solid(file, {metres_of(options.unit), false}));
  const double unit = metres_of(options.unit);
  std::vector<std::vector<double>> sizes(methods.size());
  std::vector<double> volumes;
  for (const auto& solid : solids) {
    volumes.push_back(dem::mass_properties(solid).volume);
    for (std::size_t m = 0; m < methods.size(); ++m)
      sizes[m].push_back(dem::sieve_size(solid, methods[m]));
  }

  if (options.curve.empty()) {
    std::printf("grain,method,size\n");
    for (std::size_t i = 0; i < solids.size(); ++i)
      for (std::size_t m = 0; m < methods.size(); ++m)
        std::printf("%s,%s,%s\n",
                    CsvCell(std::filesystem::path(options.grains[i]).stem().string()).text.c_str(),
                    dem::to_string(methods[m]).c_str(), tidy(sizes[m][i] / unit).c_str());
  } else {
    std::printf(
        "method,sieve_m,passing_percent,target_percent,band_min_percent,band_max_percent\n");
    for (std::size_t m = 0; m < methods.size(); ++m)
      print_curve(curve, dem::to_string(methods[m]), sizes[m], volumes);
  }
  if (std::fflush(stdout) != 0) throw RunError("the sizes cannot be printed (disk full?)");
  return 0;
}

}  // namespace trackbed::apps
