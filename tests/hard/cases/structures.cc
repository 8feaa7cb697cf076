// Structures alone: nearly incompressible soil, no load and no support, resonance, cells from far
// coarser to far finer than what presses on them.

#include "base/error.h"
#include "coupling_scene.h"
#include "hard_case.h"
#include "known/resonance.h"
#include "known/thick_cylinder.h"

namespace trackbed::hard {
namespace {

using fem::Element;
using fem::Vec;

fem::known::Cylinder cylinder(Element element, int cells) {
  return fem::known::thick_cylinder(1, element, cells, 2 * cells);
}

Measured locking(const Setting&) {
  double worst = 0;
  for (const Element element : {Element::b_bar, Element::incompatible})
    worst = std::max(worst, std::abs(1 - cylinder(element, 10).ratio));
  return {worst, .02};
}

Measured checkerboard(const Setting&) {
  double worst = 0;
  for (const Element element : {Element::b_bar, Element::incompatible})
    worst = std::max(worst, cylinder(element, 10).checkerboard);
  return {worst, .25};
}

Curve displacement_over_cells(const Setting&) {
  Curve c{"cells along the radius", "1 - displacement over the exact", true, true, {}};
  for (const int cells : {3, 5, 10, 20})
    c.points.push_back({double(cells), std::abs(1 - cylinder(Element::b_bar, cells).ratio)});
  return c;
}

fem::ElasticBodyParameters free_sleeper() {
  fem::ElasticBodyParameters p;
  p.name = "Sleeper";
  p.mesh.lengths = {2.6, .28, .2};
  p.mesh.elements = {13, 2, 2};
  p.materials = {{"concrete", 40e9, .2, 2500}};
  p.contact = {"bottom"};
  p.gravity = {0, 0, -9.81};
  return p;
}

// The mean of its base's nodes, over a hundredth of a second: it falls by half a millimetre.
// (Farther, rounding of its own stiffness times its way shows: 5e-10 after 5 cm.)
Measured free_fall(const Setting&) {
  fem::ElasticBody body(free_sleeper());
  const double dt = 1e-4;
  body.set_step(dt);
  const std::vector<Vec> none(body.surface().nodes.size(), Vec{});
  std::vector<Vec> u, v;
  double worst = 0;
  for (int n = 1; n <= 100; ++n) {
    body.advance(none);
    body.motion(u, v);
    double mean = 0;
    for (const Vec& w : v) mean += w[2] / double(v.size());
    worst = std::max(worst, std::abs(mean / (-9.81 * n * dt) - 1));
  }
  return {worst, 1e-10};
}

// 0: refused with a word on what it may still do.
Measured not_held(const Setting&) {
  try {
    fem::ElasticBody body(free_sleeper());
    body.solve_static();
  } catch (const InputError& e) {
    return {std::string(e.what()).find("not held") != std::string::npos ? 0. : 1., 0};
  }
  return {1, 0};
}

Measured resonance(const Setting&) {
  return {std::abs(fem::known::amplitude_at_resonance() - 1), .01};
}

// Give of an elastic block under a cube that is pressed into its middle by a ten-thousandth of its
// edge: the contact's nodal forces, then statics.
double give(int cells) {
  using namespace coupling;
  World w;
  set_materials(w, 1e8, 0);
  add_grain(w, dem::make_box({.05, .05, .05}), 2600, {.003, .002, .025 - 5e-6});
  const auto p = block(2e7, {.2, .2, .1}, {cells, cells, std::max(1, cells / 2)});
  w.surfaces.push_back(
      make_surface("block", 0, .01, 0, Vec3::Zero(), std::make_unique<fem::ElasticBody>(p)));
  start(w, context(1e-6, Vec3::Zero()));
  fem::ElasticBody alone(p);
  std::vector<Vec> f, u, v;
  double sum = 0, work = 0;
  for (int i = 0; i < w.surfaces[0].patch.carried; ++i) {
    const Vec3& force = w.surfaces[0].patch.force[i];
    f.push_back({force.x(), force.y(), force.z()});
    sum += force.z();
  }
  alone.solve_static(f);
  alone.motion(u, v);
  for (std::size_t i = 0; i < f.size(); ++i) work += f[i][2] * u[i][2];
  return work / (sum * sum);
}

// Cells of four times the cube's edge to an eighth of it.
Measured convergence(const Setting&) { return {std::abs(give(16) / give(32) - 1), .05}; }

Curve give_over_cells(const Setting&) {
  Curve c{"cells a cube's edge", "give [m/N]", true, false, {}};
  for (const int cells : {1, 2, 4, 8, 16, 32}) c.points.push_back({cells * .05 / .2, give(cells)});
  return c;
}

}  // namespace

const std::vector<Case>& structure_cases() {
  static const std::vector<Case> cases{
      {"Poisson ratio .4999: thick cylinder", "does not lock", "1 - displacement over the exact",
       "none", Over::once, false, false, locking, displacement_over_cells},
      {"Poisson ratio .4999: pressure", "no checkerboard",
       "difference of neighbouring cells, share of the pressure", "none", Over::once, false, false,
       checkerboard},
      {"elastic sleeper that touches nothing", "falls with g", "relative difference of the speed",
       "none", Over::once, false, false, free_fall},
      {"statics of a structure that nothing holds", "refused, and says what is free",
       "1 = not refused", "none", Over::once, false, false, not_held},
      {"load at resonance", "F/(2 xi k)", "relative difference of the amplitude", "5 %, viscous",
       Over::once, false, false, resonance},
      {"elements from 4 times the grain's size to 1/8", "give under the grain converges",
       "of the last halving, relative", "none", Over::once, false, false, convergence,
       give_over_cells}};
  return cases;
}

}  // namespace trackbed::hard
