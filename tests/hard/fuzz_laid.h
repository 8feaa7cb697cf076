// The grains of fuzz_surface, laid on random surfaces.
#pragma once
#include <cmath>
#include <string>

#include "base/error.h"
#include "dem/grain/parts.h"
#include "dem/surface/round_patch.h"
#include "tests/hard/fuzz_grains.h"
#include "tests/hard/fuzz_ground.h"

namespace trackbed::dem::test {

inline constexpr double kModulus = 1e9, kStiffness = 1e6;

/// A grain as it was laid on its surface.
struct Case {
  GrainShape grain;
  std::string law;
  bool plain = false, stores = true;
  double most = HUGE_VAL;  ///< how deep it may be [m]
  Ground ground;
  double depth = 0;
  Vec3 x;
  Mat3 R;
};

inline void set_stiffness(PairMaterials& materials) {
  PairMaterial m = materials(0, 0);
  m.stiffness = kStiffness;
  materials.set(0, 0, m);
}

struct Answer {
  Vec3 force, torque;
  double energy;
};

/// The scene of that grain on a surface.
struct OnGround : PatchScene {
  bool flats;

  OnGround(const Case& c, const Ground& g)
      : PatchScene(g.mesh, g.shell, g.skirt, kModulus, 0, c.plain ? c.law : "stored_energy",
                   g.period),
        flats(c.law == "hertz_flat") {
    if (!c.plain) law = make_round_patch_forces(c.law, false);
    set_stiffness(materials);
    travel.push_back(0);
    add_grain(bodies, shapes, shapes.add(c.grain), 0, 1, Vec3::Zero());
  }
  const PartView& part() const { return flats ? shapes.flat_part(0, 0) : shapes.part(0, 0); }
  Answer answer(const Vec3& x, const Mat3& R) {
    test::place(bodies, 0, x, R);
    evaluate_afresh();
    return {bodies.force[0], bodies.torque[0], energy()};
  }
};

inline void draw_grain(Random& random, Case& c) {
  const unsigned kind = random.below(6);
  if (kind < 2) {
    c.plain = true, c.stores = random.below(4) > 0;
    c.law = c.stores ? "stored_energy" : "shao2017";
    c.grain = make_grain_shape(any_core(random));
    return;
  }
  static const char* laws[] = {"hertz_mindlin", "sun2015", "linear", "hertz_flat"};
  c.law = kind == 3 ? "hertz_flat" : laws[random.below(4)];
  const double r = random.uniform(.03, .3);
  c.most = r / 2;
  if (kind == 4) {
    c.grain = sphere_shape(r);
  } else if (kind == 5) {
    std::vector<Sphere> spheres{{Vec3::Zero(), r}};
    for (int k = 0; k < 3; ++k)
      spheres.push_back({.25 * random.below(3) * random.direction(), r * random.uniform(.5, 1)});
    c.grain = as_grain(make_clump_shape(spheres));
    c.most = r / 4;
  } else {
    c.grain = as_grain(make_dilated_shape({any_core(random), r}));
  }
}

/// From where it does not touch down to where it does, then as deep as it should be.
inline void sink(Random& random, const Vec3& aside, OnGround& s, Case& c) {
  const Ground& g = c.ground;
  const auto place_at = [&](double height) { return Vec3(g.at - aside + height * g.up); };
  const auto touches = [&](double height) {
    try {
      s.answer(place_at(height), c.R);
      return count_contacts(s.contacts) > 0;
    } catch (const RunError&) {  // too deep
      return true;
    }
  };
  const double stride = std::min(g.shell, c.most) / 4;  // a thin grain might pass the shell
  double apart = 2 * c.grain.radius;
  while (touches(apart)) apart += stride;
  double touching = apart - stride;
  while (!touches(touching)) apart = touching, touching -= stride;
  for (int k = 0; k < 50; ++k) {
    const double middle = (touching + apart) / 2;
    (touches(middle) ? touching : apart) = middle;
  }
  const double deepest = std::min(c.most, g.bent ? g.shell / 4 : .9 * g.shell);
  c.depth = std::pow(10., random.uniform(-5, std::log10(deepest)));
  c.x = place_at(touching - c.depth);
}

/// By a vertex, an edge or a face.
inline void lay(Random& random, Case& c) {
  OnGround s(c, c.ground);
  const Vec3& up = c.ground.up;
  const PartView& part = s.part();
  const bool point = part.kind == Core::point;
  const Vec3 own = point ? random.direction() : any_direction(random, part.core);
  const double spin = random.below(2) ? random.below(8) * M_PI / 4 : random.uniform(0, 6);
  const Mat3 R = rotation(any_tilt(random) * random.direction()) * rotation(spin * up) *
                 Quat::FromTwoVectors(own, -up).toRotationMatrix();
  place(s.bodies, 0, Vec3::Zero(), R);
  c.R = s.bodies.R[0];
  Vec3 low = Vec3::Zero();
  double high = 0;
  for (int k = 0; k < part.core.vertices; ++k) {
    const Vec3 p = c.R * Vec3(part.core.x[k], part.core.y[k], part.core.z[k]);
    if (p.dot(up) < low.dot(up)) low = p;
    high = std::max(high, p.dot(up));
  }
  if (c.plain) c.most = (high - low.dot(up)) / 2;
  // Its centre over the point, or its lowest vertex.
  sink(random, random.below(2) ? Vec3(Vec3::Zero()) : Vec3(low - low.dot(up) * up), s, c);
}

}  // namespace trackbed::dem::test
