#include "apps/trackbed/simulation/grains.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "apps/trackbed/csv.h"
#include "base/error.h"
#include "dem/grain/dilated_shape.h"
#include "dem/grain/parts.h"

namespace trackbed::apps {

namespace {

// In the order of their names, so that the library is the same everywhere.
std::vector<std::string> stone_files(const Scene& s) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  if (s.grains.generator != "files") return files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(s.grains.stones, failed)) {
    std::string kind = entry.path().extension().string();
    for (char& c : kind) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (kind == ".off" || kind == ".obj" || kind == ".stl") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw InputError("Grains/Stones = " + s.grains.stones +
                     ": is no folder that holds OFF, OBJ or STL files");
  return files;
}

// Enough needles or flakes to draw a share [%] from without dealing the same few again and again.
int special_shapes(double share, int library) {
  return share > 0 ? static_cast<int>(std::ceil(library * std::max(0.05, 0.01 * share) / 2)) : 0;
}

}  // namespace

dem::LibraryParameters library_parameters(const Scene& s) {
  const GrainScene& g = s.grains;
  dem::LibraryParameters p;
  p.files = stone_files(s);
  p.hull = g.hull;
  p.generator = g.generator;
  p.count = p.files.empty() ? g.library : static_cast<int>(p.files.size());
  p.seed = g.seed;
  p.method = dem::parse_sieve_method(g.sieve_method);
  p.elongation = g.elongation, p.flatness = g.flatness;
  p.sphericity = g.sphericity, p.angularity = g.angularity;
  p.spacing = g.spacing, p.least_face = g.least_face;
  p.axes = dem::Vec3(g.axes[0], g.axes[1], g.axes[2]);
  p.points_least = g.points_least, p.points_most = g.points_most;
  p.length_over_height = g.length_over_height;
  p.length_over_height_deviation = g.length_over_height_deviation;
  p.divisions = g.divisions, p.least_scale = g.least_scale, p.largest_scale = g.largest_scale;
  p.needles = special_shapes(s.gradation.needle_share, p.count);
  p.flakes = special_shapes(s.gradation.flaky_share, p.count);
  return p;
}

namespace {

std::vector<dem::GrainShape> shapes_of(const Scene& s, const std::string& shape,
                                       const dem::LibraryParameters& p,
                                       const std::function<void(double)>& progress) {
  const GrainScene& g = s.grains;
  if (shape == "sphere") return std::vector<dem::GrainShape>(p.count, dem::sphere_shape(0.5));
  std::vector<dem::GrainShape> shapes;
  if (shape == "clump") {
    for (const dem::ClumpShape& c :
         dem::make_clump_library(p, g.clump_least_radius, g.clump_space_factor, progress))
      shapes.push_back(dem::as_grain(c));
    return shapes;
  }
  shapes = dem::make_library(p, progress);
  if (shape == "dilated")
    for (dem::GrainShape& grain : shapes)
      grain = dem::as_grain(dem::dilate_within(grain, g.dilation));
  return shapes;
}

}  // namespace

bool has_shape(const Scene& s, const std::string& shape) {
  const GrainScene& g = s.grains;
  return (g.other_share < 1 && g.shape == shape) || (g.other_share > 0 && g.other_shape == shape);
}

std::vector<dem::GrainShape> make_grain_library(const Scene& s, dem::LibraryParameters p,
                                                const std::function<void(double)>& progress) {
  const int other = static_cast<int>(std::round(s.grains.other_share * p.count));
  const int first = p.count - other;
  std::vector<dem::GrainShape> shapes;
  if (first > 0) {
    p.needles = p.needles * first / p.count, p.flakes = p.flakes * first / p.count;
    p.count = first;
    shapes = shapes_of(s, s.grains.shape, p, progress);
  }
  if (other > 0) {
    p.count = other;
    p.needles = p.flakes = 0;
    for (dem::GrainShape& g : shapes_of(s, s.grains.other_shape, p, progress))
      shapes.push_back(std::move(g));
  }
  return shapes;
}

std::vector<dem::GrainShape> make_grain_library(const Scene& s,
                                                const std::function<void(double)>& progress) {
  return make_grain_library(s, library_parameters(s), progress);
}

dem::SieveCurve gradation_curve(const Scene& s) {
  const GradationScene& g = s.gradation;
  dem::SieveCurve curve =
      g.curve == "table" ? dem::make_curve(g.sieves, g.passing) : dem::named_curve(g.curve);
  if (curve.passing.back() < 100 && g.top_sieve > curve.sieve.back()) curve.top = g.top_sieve;
  dem::validate(curve);
  return curve;
}

namespace {

// What goes wrong with needles and flakes names their keys.
dem::GradationDraw draw_or_name_shares(const Scene& s, const std::vector<dem::GrainShape>& library,
                                       const dem::DrawParameters& p) try {
  return dem::draw_gradation(gradation_curve(s), library, p);
} catch (const InputError& e) {
  if (p.needle_share <= 0 && p.flaky_share <= 0) throw;
  throw InputError(s.file + ": Gradation/Needle share = " + shortest(p.needle_share) +
                   ", Flaky share = " + shortest(p.flaky_share) + ": " + e.what());
}

}  // namespace

std::vector<dem::GrainShape> draw_grains(const Scene& s,
                                         const std::vector<dem::GrainShape>& library, double mass,
                                         int stream) {
  dem::DrawParameters p;
  p.volume = mass / s.grains.density;
  p.seed = s.grains.seed * 1000003 + stream;
  p.tolerance = 100 * s.gradation.tolerance;
  p.needle_share = s.gradation.needle_share, p.flaky_share = s.gradation.flaky_share;
  const dem::GradationDraw draw = draw_or_name_shares(s, library, p);
  std::vector<dem::GrainShape> grains;
  grains.reserve(draw.grains.size());
  for (const dem::DrawnGrain& g : draw.grains)
    grains.push_back(dem::scaled(library[g.shape], g.scale));
  return grains;
}

}  // namespace trackbed::apps
