#include "dem/packing/measure.h"

#include <cmath>

#include "base/error.h"

namespace trackbed::dem {
namespace {

// What to add to a grain's place so that it may reach into the region: its images.
std::vector<Vec3> images(const PlacedGrain& g, const Vec3& period, const MeasuredRegion& r) {
  std::vector<Vec3> shifts = {Vec3::Zero()};
  const Vec3 low(r.low.x(), r.low.y(), r.low_z), high(r.high.x(), r.high.y(), r.high_z);
  for (int k = 0; k < 3; ++k) {
    if (!(period[k] > 0)) continue;
    std::vector<Vec3> more;
    const int from = int(std::ceil((low[k] - g.radius - g.x[k]) / period[k]));
    const int to = int(std::floor((high[k] + g.radius - g.x[k]) / period[k]));
    for (const Vec3& s : shifts)
      for (int i = from; i <= to; ++i) more.push_back(s + i * period[k] * Vec3::Unit(k));
    shifts.swap(more);
  }
  return shifts;
}

double cut_volume(const PlacedGrain& g, const Vec3& x, const MeasuredRegion& r) {
  if (!g.outline->spheres.empty()) {
    std::vector<Sphere> placed;
    for (const Sphere& s : g.outline->spheres) placed.push_back({x + g.R * s.centre, s.radius});
    return volume_inside(placed, r);
  }
  double whole = 0, part = 0;
  std::vector<Vec3> vertices;
  for (const Polyhedron& body : g.outline->bodies) {
    vertices.clear();
    for (const Vec3& v : body.vertices) vertices.push_back(x + g.R * v);
    part += volume_inside(vertices, body.faces, r);
    whole += mass_properties(body).volume;
  }
  return part * (g.volume / whole);  // an outline that is but near carries the true volume
}

double inside(const PlacedGrain& g, const Vec3& period, const MeasuredRegion& r) {
  double sum = 0;
  for (const Vec3& shift : images(g, period, r)) {
    const Inside in = where(r, g.x + shift, g.radius);
    if (in == Inside::all) sum += g.volume;
    if (in == Inside::cut) sum += cut_volume(g, g.x + shift, r);
  }
  return sum;
}

bool centre_in(const PlacedGrain& g, const Vec3& period, const MeasuredRegion& r) {
  for (const Vec3& shift : images(g, period, r))
    if (contains(r, g.x + shift)) return true;
  return false;
}

std::shared_ptr<const GrainOutline> outline_of(const GrainShape& s) {
  auto outline = std::make_shared<GrainOutline>();
  if (s.parts.empty()) outline->bodies.push_back(s.body);
  for (const ConvexPart& part : s.parts) {
    if (part.core.faces.empty())
      outline->spheres.push_back({part.core.vertices.front(), part.radius});
    else  // a crown is too small to be seen
      outline->bodies.push_back(rounded_outline(part.core, part.radius));
  }
  return outline;
}

}  // namespace

std::vector<PlacedGrain> placed_grains(const Bodies& b, const ShapeTable& shapes) {
  std::vector<PlacedGrain> grains(b.grains);
  for (int i = 0; i < b.grains; ++i) {
    const GrainShape& s = shapes.shape(b.shape[i]);
    grains[i].outline = outline_of(s);
    grains[i].x = b.x[i], grains[i].R = b.R[i];
    grains[i].radius = s.radius, grains[i].volume = s.volume;
    grains[i].density = b.mass[i] / s.volume;
  }
  return grains;
}

std::vector<std::pair<int, int>> grain_contacts(const Pairs& pairs, int grains) {
  std::vector<std::pair<int, int>> contacts;
  for (int p = 0; p < pairs.size(); ++p) {
    const std::pair<int, int> pair{pairs.a[p], pairs.b[p]};
    if (!pairs.touching[p] || pair.first >= grains || pair.second >= grains) continue;
    if (contacts.empty() || contacts.back() != pair) contacts.push_back(pair);
  }
  return contacts;
}

RegionMeasure measure(const std::vector<PlacedGrain>& grains,
                      const std::vector<std::pair<int, int>>& contacts, const Vec3& period,
                      const MeasuredRegion& region) {
  const int n = int(grains.size());
  std::vector<double> part(n);
  std::vector<char> counts(n);
#pragma omp parallel for schedule(dynamic, 16)
  for (int i = 0; i < n; ++i) {
    part[i] = inside(grains[i], period, region);
    counts[i] = centre_in(grains[i], period, region);
  }
  RegionMeasure m;
  m.volume = volume(region);
  for (int i = 0; i < n; ++i) {
    m.solid_volume += part[i];
    m.mass += grains[i].density * part[i];
    m.grains += counts[i];
  }
  for (const auto& [a, b] : contacts) m.coordination += counts[a] + counts[b];
  m.coordination /= std::max(1, m.grains);
  m.density = m.mass / m.volume;
  m.porosity = 1 - m.solid_volume / m.volume;
  m.void_ratio = m.solid_volume > 0 ? m.volume / m.solid_volume - 1 : 0;
  return m;
}

std::vector<RegionMeasure> measure_layers(const std::vector<PlacedGrain>& grains,
                                          const std::vector<std::pair<int, int>>& contacts,
                                          const Vec3& period, const MeasuredRegion& r, int layers) {
  if (layers < 1) throw InputError("porosity profile: at least one layer is needed");
  std::vector<RegionMeasure> profile;
  const double thickness = (r.high_z - r.low_z) / layers;
  for (int k = 0; k < layers; ++k)
    profile.push_back(measure(grains, contacts, period,
                              layer_of(r, r.low_z + k * thickness, r.low_z + (k + 1) * thickness)));
  return profile;
}

}  // namespace trackbed::dem
