#include "dem/packing/grain_pieces.h"

#include <algorithm>
#include <cmath>

#include "dem/grain/parts.h"
#include "dem/packing/measure.h"

namespace trackbed::dem {
namespace {

// Around a unit sphere's centre, of its volume.
const Polyhedron& round_piece() {
  static const Polyhedron piece = [] {
    Polyhedron p = polyhedron_around_sphere(1);
    const double factor = std::cbrt(4. / 3 * M_PI / mass_properties(p).volume);
    for (Vec3& v : p.vertices) v *= factor;
    return p;
  }();
  return piece;
}

Polyhedron outline(const ConvexPart& part) {
  if (!part.core.faces.empty()) return rounded_outline(part.core, part.radius);
  Polyhedron p = round_piece();
  for (Vec3& v : p.vertices) v = part.core.vertices[0] + part.radius * v;
  return p;
}

}  // namespace

GrainKind kind_of(const GrainShape& s) {
  if (s.parts.empty()) return GrainKind::polyhedron;
  if (std::all_of(s.parts.begin(), s.parts.end(),
                  [](const ConvexPart& p) { return p.core.faces.empty(); }))
    return GrainKind::spheres;
  return s.parts.size() == 1 && s.parts[0].radius > 0 ? GrainKind::dilated : GrainKind::pieces;
}

const char* name_of(GrainKind kind) {
  static const char* const names[] = {"polyhedron", "spheres", "dilated", "pieces"};
  return names[static_cast<int>(kind)];
}

std::vector<Sphere> spheres_of(const GrainShape& s) {
  std::vector<Sphere> spheres;
  for (const ConvexPart& p : s.parts) spheres.push_back({p.core.vertices[0], p.radius});
  return spheres;
}

std::vector<Polyhedron> outline_pieces(const GrainShape& s) {
  if (s.parts.empty()) return {s.body};
  std::vector<Polyhedron> pieces;
  for (const ConvexPart& p : s.parts) pieces.push_back(outline(p));
  return pieces;
}

}  // namespace trackbed::dem
