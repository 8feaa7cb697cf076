// The law of Shao, Lian, Yang 2017, Eq. 17, as printed:
//
//   F_N = 4E sqrt(V d)/(3 sqrt(pi))                                                         [N]
//
// V volume of the overlap [m3], d its extent along the contact frame's normal n [m], E modulus
// [Pa], along n, spread evenly over the overlap's area projected along n. It is not the gradient of
// an energy where the contact's area changes: a closed loop of two cubes, depth x0 -> x1, width y0
// -> y1, z long, gains k sqrt(z)/2 (x1^2-x0^2)(sqrt(y1)-sqrt(y0)); so it stores none (energy 0) and
// is offered by name, to reproduce the paper's results.
// n is that of the overlap's vector area in the step itself (pair_evaluate.h makes the frame anew).
//
// Stiffness: sqrt(V d) grows as d face on face (dF/dd = 4E sqrt(S)/(3 sqrt(pi))), as d^2 at a
// vertex (V=Sd/3: 2/sqrt(3) of that) and as d^(3/2) at an edge (V=Sd/2: 1.5/sqrt(2) of that); the
// bound is 1.155 x 4E sqrt(|S|)/(3 sqrt(pi)).
#pragma once
#include <cmath>

#include "dem/contact/laws/pressure_law.h"

namespace trackbed::dem {

struct Shao2017Law {
  static constexpr const char* name = "shao2017";
  static constexpr bool stores_energy = false;
  NormalResponse operator()(const OverlapShape& s, const PairMaterial& m) const {
    NormalResponse r;
    const double area = std::abs(s.area.z());
    if (!(s.volume > 0) || !(s.depth > 0) || !(area > 0)) return r;
    const double k = kShaoFactor * m.modulus;  // Eq. 18
    r.p0 = k * std::sqrt(s.volume * s.depth) / area;
    r.acts_on = Vec3(0, 0, 1);
    r.stiffness = 1.1547005383792515 * k * std::sqrt(area);
    return r;
  }
};

}  // namespace trackbed::dem
