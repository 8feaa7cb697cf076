// `trackbed sieve`: sizes of solids as CSV; a sample's curve against a standard's band.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "apps/trackbed/commands.h"
#include "apps/trackbed/csv.h"
#include "apps/trackbed/progress.h"
#include "base/error.h"
#include "dem/grading/curve.h"
#include "dem/grading/rounded_sieve_size.h"
#include "dem/grain/clump_io.h"
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

/// A grain of a file: a convex solid, dilated or not, or a clump.
struct FileGrain {
  std::string name;
  dem::DilatedPolyhedron solid;  ///< radius 0: plain
  std::vector<dem::Sphere> clump;

  bool rounded() const { return !clump.empty() || solid.radius > 0; }
  double volume() const {
    return clump.empty() ? dem::dilated_volume(solid) : dem::mass_properties(clump).volume;
  }
  double size(dem::SieveMethod method) const {
    if (!clump.empty()) return dem::sieve_size(clump, method);
    return rounded() ? dem::sieve_size(solid, method) : dem::sieve_size(solid.core, method);
  }
};

std::vector<FileGrain> read_grains(const SieveOptions& o) {
  const double unit = metres_of(o.unit);
  std::vector<FileGrain> grains;
  for (const auto& file : o.grains) {
    const std::filesystem::path path(file);
    FileGrain grain;
    grain.name = path.stem().string();
    if (path.extension() == ".csv") {
      grain.clump = dem::read_clump(file, unit);
      grains.push_back(grain);
      continue;
    }
    const auto solids = dem::read_solids(file, {unit, o.hull});
    for (std::size_t k = 0; k < solids.size(); ++k) {
      if (solids.size() > 1) grain.name = path.stem().string() + "#" + std::to_string(k + 1);
      grain.solid = {solids[k], unit * o.dilation};
      grains.push_back(grain);
    }
  }
  return grains;
}

/// "all": those that are defined for every grain of the sample; the rules of shao2017 and
/// min_shadow name directions of a polyhedron.
std::vector<dem::SieveMethod> methods_of(const std::string& name,
                                         const std::vector<FileGrain>& grains) {
  if (name != "all") return {dem::parse_sieve_method(name)};
  const bool rounded =
      std::any_of(grains.begin(), grains.end(), [](const FileGrain& g) { return g.rounded(); });
  std::vector<dem::SieveMethod> methods;
  for (const auto& word : dem::sieve_method_names()) {
    const dem::SieveMethod m = dem::parse_sieve_method(word);
    if (!rounded || (m != dem::SieveMethod::shao2017 && m != dem::SieveMethod::min_shadow))
      methods.push_back(m);
  }
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
  if (options.method != "all") dem::parse_sieve_method(options.method);  // wrong names first
  dem::SieveCurve curve;
  if (!options.curve.empty()) curve = dem::named_curve(options.curve);
  const auto grains = read_grains(options);  // all are read before anything is printed
  const auto methods = methods_of(options.method, grains);

  const double unit = metres_of(options.unit);
  std::vector<std::vector<double>> sizes(methods.size());
  std::vector<double> volumes;
  Progress progress;
  for (const auto& grain : grains) {
    volumes.push_back(grain.volume());
    for (std::size_t m = 0; m < methods.size(); ++m) sizes[m].push_back(grain.size(methods[m]));
    progress.portion("sizes", double(volumes.size()) / double(grains.size()));
  }

  if (options.curve.empty()) {
    std::printf("grain,method,size\n");
    for (std::size_t i = 0; i < grains.size(); ++i)
      for (std::size_t m = 0; m < methods.size(); ++m)
        std::printf("%s,%s,%s\n", CsvCell(grains[i].name).text.c_str(),
                    dem::to_string(methods[m]).c_str(), tidy(sizes[m][i] / unit).c_str());
  } else {
    if (!curve.checked)
      std::fprintf(stderr, "note: %s (%s) is unchecked against its text%s%s\n", curve.name.c_str(),
                   curve.source.c_str(),
                   curve.compared.empty() ? "" : "; compared: ", curve.compared.c_str());
    std::printf(
        "method,sieve_m,passing_percent,target_percent,band_min_percent,band_max_percent\n");
    for (std::size_t m = 0; m < methods.size(); ++m)
      print_curve(curve, dem::to_string(methods[m]), sizes[m], volumes);
  }
  if (std::fflush(stdout) != 0) throw RunError("the sizes cannot be printed (disk full?)");
  return 0;
}

}  // namespace trackbed::apps
