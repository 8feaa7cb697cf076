#include "dem/grain/library_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace trackbed::dem {
namespace {

Spread spread(const std::vector<double>& values) {
  Spread s;
  const double n = double(values.size());
  for (double v : values) s.mean += v / n;
  for (double v : values) s.deviation += (v - s.mean) * (v - s.mean) / std::max(1.0, n - 1);
  s.deviation = std::sqrt(s.deviation);
  s.least = *std::min_element(values.begin(), values.end());
  s.largest = *std::max_element(values.begin(), values.end());
  return s;
}

}  // namespace

LibraryReport library_report(const std::vector<GrainShape>& shapes) {
  LibraryReport r;
  std::vector<ShapeIndices> indices;
  for (const GrainShape& shape : shapes) indices.push_back(shape_indices(shape.body));
  r.indices = library_indices(shapes, indices);
  r.shapes = static_cast<int>(shapes.size());
  std::vector<double> elongation, flatness, sphericity, angularity, faces, solidity;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const GrainShape& shape = shapes[k];
    const ShapeIndices& s = indices[k];
    elongation.push_back(s.elongation);
    flatness.push_back(s.flatness);
    sphericity.push_back(s.sphericity);
    angularity.push_back(s.angularity);
    faces.push_back(double(shape.body.faces.size()));
    solidity.push_back(shape.volume / std::pow(shape.sieve_size, 3));
  }
  r.elongation = spread(elongation), r.flatness = spread(flatness);
  r.sphericity = spread(sphericity), r.angularity = spread(angularity);
  r.faces = spread(faces), r.solidity = spread(solidity);
  return r;
}

std::string to_csv(const LibraryReport& r) {
  std::string text = "index,mean,deviation,least,largest\n";
  char line[160];
  const auto add = [&](const char* name, const Spread& s) {
    std::snprintf(line, sizeof line, "%s,%.6g,%.6g,%.6g,%.6g\n", name, s.mean, s.deviation, s.least,
                  s.largest);
    text += line;
  };
  add("elongation", r.elongation);
  add("flatness", r.flatness);
  add("sphericity", r.sphericity);
  add("angularity", r.angularity);
  add("faces", r.faces);
  add("solidity", r.solidity);
  const auto percent = [&](const char* name, double value) {
    std::snprintf(line, sizeof line, "%s,%.6g,,,\n", name, value);
    text += line;
  };
  percent("flakiness_index_percent", r.indices.flaky);
  percent("elongation_index_percent", r.indices.elongated);
  percent("shape_index_percent", r.indices.slender);
  return text;
}

}  // namespace trackbed::dem
