#include "apps/trackbed/check_scene.h"

#include <algorithm>
#include <cmath>

#include "apps/trackbed/csv.h"
#include "apps/trackbed/grain_estimate.h"
#include "apps/trackbed/simulation/grains.h"
#include "apps/trackbed/simulation/materials.h"
#include "base/error.h"
#include "dem/grading/curve.h"
#include "dem/motion/bodies.h"

namespace trackbed::apps {
namespace {

/// Collects what every message needs.
struct Check {
  const Scene& scene;
  const ParameterValues& values;

  [[noreturn]] void refuse(const std::string& path, const std::string& why) const {
    values.refuse(path, why);
  }
};

std::string metres(double value) { return shortest(std::round(value * 1e9) / 1e9) + " m"; }

void check_gradation(const Check& c) {
  const auto& g = c.scene.gradation;
  if (g.curve != "table") {
    if (!g.sieves.empty())
      c.refuse("Gradation/Sieves",
               "is used only with Gradation/Curve = table, not with " + g.curve);
    if (!g.passing.empty())
      c.refuse("Gradation/Passing",
               "is used only with Gradation/Curve = table, not with " + g.curve);
  } else {
    if (g.sieves.empty())
      c.refuse("Gradation/Curve", "needs Gradation/Sieves and Gradation/Passing");
    if (g.sieves.size() != g.passing.size())
      c.refuse("Gradation/Passing", "has " + std::to_string(g.passing.size()) + " values for " +
                                        std::to_string(g.sieves.size()) +
                                        " of Gradation/Sieves; one each is needed");
    for (std::size_t i = 1; i < g.sieves.size(); ++i) {
      if (g.sieves[i] <= g.sieves[i - 1])
        c.refuse("Gradation/Sieves", shortest(g.sieves[i]) + " m follows " +
                                         shortest(g.sieves[i - 1]) +
                                         " m; openings must rise from sieve to sieve");
      if (g.passing[i] < g.passing[i - 1])
        c.refuse("Gradation/Passing", "the curve decreases from " + shortest(g.passing[i - 1]) +
                                          " % at " + metres(g.sieves[i - 1]) + " to " +
                                          shortest(g.passing[i]) + " % at " + metres(g.sieves[i]) +
                                          "; passing must never fall as sieves widen");
    }
    if (g.passing.front() > 0 && g.sieves.size() == 1 && g.passing.front() < 100)
      c.refuse("Gradation/Sieves", "one sieve makes no class; at least two are needed");
  }
  const auto curve =
      g.curve == "table" ? dem::make_curve(g.sieves, g.passing) : dem::named_curve(g.curve);
  if (curve.passing.back() < 100 && g.top_sieve <= curve.sieve.back())
    c.refuse("Gradation/Top sieve", "the curve ends below 100 % at " + metres(curve.sieve.back()) +
                                        ", so the largest grains need a wider sieve than that");
  const auto classes = gradation_classes(c.scene);
  if (classes.empty())
    c.refuse("Gradation/Passing", "no class holds any mass; passing must reach beyond 0 %");
  const double largest = classes.back().upper;
  const double room = std::min({c.scene.container.length * (c.scene.container.half ? 0.5 : 1.0),
                                c.scene.container.width, c.scene.container.depth});
  if (largest > 0.5 * room)
    c.refuse("Container/Width", "the narrowest side of the bed is " + metres(room) +
                                    "; two of the largest grains (" + metres(largest) +
                                    ") must fit");
  if (c.scene.container.periodic && c.scene.container.width < 3 * largest)
    c.refuse("Container/Width", "a periodic bay is at least three of the largest grains long, " +
                                    metres(3 * largest) + " by their sieve size");
  for (const auto& k : classes)
    if (k.share > g.tolerance && k.grains < 0.5)
      c.refuse(g.curve == "table" ? "Gradation/Passing" : "Gradation/Curve",
               "the class from " + metres(k.lower) + " to " + metres(k.upper) +
                   " would hold no grain: its " + shortest(std::round(1000 * k.share) / 10) +
                   " % of the mass is less than half a grain; widen the box or join classes");
}

void check_grains(const Check& c) {
  const auto& g = c.scene.grains;
  if (g.axes.size() != 3) c.refuse("Grains/Ellipsoid axes", "three numbers are needed");
  if (g.points_least > g.points_most)
    c.refuse("Grains/Ellipsoid least corners", "at most Grains/Ellipsoid most corners");
  if (g.least_scale > g.largest_scale)
    c.refuse("Grains/Least scale", "at most Grains/Largest scale = " + shortest(g.largest_scale));
  if (g.sphericity > 0 && (g.elongation > 0 || g.flatness > 0))
    c.refuse("Grains/Sphericity", "Grains/Elongation and Flatness fix it; give one or the other");
  const auto& d = c.scene.gradation;
  if (d.needle_share + d.flaky_share > 100)
    c.refuse("Gradation/Needle share", "at most 100 % together with Gradation/Flaky share");
  const bool spheres = (g.other_share >= 1 || g.shape == "sphere") &&
                       (g.other_share <= 0 || g.other_shape == "sphere");
  for (const auto& [key, share] : {std::pair{"Gradation/Needle share", d.needle_share},
                                   std::pair{"Gradation/Flaky share", d.flaky_share}})
    if (spheres && share > 0) c.refuse(key, "spheres (Grains/Shape) are neither needles nor flaky");
}

void check_shapes(const Check& c) {
  const auto& g = c.scene.grains;
  const bool rounded = has_shape(c.scene, "clump") || has_shape(c.scene, "dilated");
  if (rounded && g.sieve_method != "exact")
    c.refuse("Grains/Sieve method", "clumps and dilated grains are sized by exact only");
  make_materials(c.scene, c.scene.contact.modulus, g.friction);  // reads Contact/Pairs
}

void check_measures(const Check& c) {
  const auto& m = c.scene.measures;
  if (m.low.size() != m.high.size() || (!m.low.empty() && m.low.size() != 3))
    c.refuse("Measures/High", "Low and High are three numbers each, or empty both");
  for (std::size_t k = 0; k < m.low.size(); ++k)
    if (m.low[k] >= m.high[k]) c.refuse("Measures/High", "above Measures/Low in x, y and z");
}

void check_sleeper(const Check& c) {
  if (c.scene.test.on()) return;  // it has none
  const auto& s = c.scene.sleeper;
  const auto& box = c.scene.container;
  if (s.length > box.length)
    c.refuse("Sleeper/Length",
             "longer than the box; at most Container/Length = " + metres(box.length));
  if (s.width > box.width || (box.periodic && s.width >= box.width))
    c.refuse("Sleeper/Width", std::string("wider than the ") + (box.periodic ? "bay" : "box") +
                                  "; at most Container/Width = " + metres(box.width));
  if (s.elements.size() != 3)
    c.refuse("Sleeper/Elements", "three numbers are needed, in x, y and z");
  for (const double n : s.elements)
    if (n != std::floor(n)) c.refuse("Sleeper/Elements", "whole numbers are needed");
  if (s.pad_thickness >= s.height)
    c.refuse("Sleeper/Pad thickness", "less than Sleeper/Height = " + metres(s.height));
  if (s.seats.empty()) c.refuse("Sleeper/Seats", "at least one rail seat is needed");
  for (const double x : s.seats)
    if (std::abs(x) + 0.5 * s.seat_length > 0.5 * s.length * (1 + 1e-12))
      c.refuse("Sleeper/Seats",
               "the seat at x = " + metres(x) + " of Seat length " + metres(s.seat_length) +
                   " lies outside the sleeper, which ends at " + metres(0.5 * s.length));
  if (s.seat_width > s.width)
    c.refuse("Sleeper/Seat width", "at most Sleeper/Width = " + metres(s.width));
  if (box.half) {
    auto mirrored = s.seats;
    for (auto& x : mirrored) x = -x;
    auto given = s.seats;
    std::sort(mirrored.begin(), mirrored.end());
    std::sort(given.begin(), given.end());
    if (mirrored != given)
      c.refuse("Sleeper/Seats", "Container/Half by symmetry needs seats that mirror each other");
    if (given.size() > 1 && std::any_of(given.begin(), given.end(), [&](double x) {
          return std::abs(x) < 0.5 * s.seat_length;
        }))
      c.refuse("Sleeper/Seats", "Container/Half by symmetry cuts one seat of several in two");
  }
  if (s.model == "elastic" && s.reduction == "none" && c.scene.numerics.scheme == "static")
    c.refuse("Numerics/Structure scheme",
             "a sleeper on grains is not held, so a static answer does not exist; Sleeper/Model = "
             "rigid or beam, or another scheme");
  if (s.model == "beam" && !s.mesh.empty())
    c.refuse("Sleeper/Mesh", "holds for Sleeper/Model = elastic only; a beam is a block");
  if (s.model == "beam" && s.pad_thickness > 0)
    c.refuse("Sleeper/Pad thickness", "a pad is made with Sleeper/Model = elastic only");
  if (s.rail_pad.damping > 0 && s.rail_pad.stiffness == 0)
    c.refuse("Sleeper/Pad damping", "a pad of no stiffness; give Sleeper/Pad stiffness too");
  if (s.freedom < 0)
    c.refuse("Sleeper/Degrees of freedom",
             "six, vertical, or a list of x, y, z, turn x, turn y and turn z, each once at most");
  if (!(s.freedom & dem::kMoveZ))
    c.refuse("Sleeper/Degrees of freedom", "z must be among them: the load acts along it");
  if (s.freedom != dem::kFree && s.model != "rigid")
    c.refuse("Sleeper/Degrees of freedom", "holds for Sleeper/Model = rigid only");
  if (!s.mesh.empty() && s.pad_thickness > 0)
    c.refuse("Sleeper/Pad thickness", "a pad is made with a block only, not with Sleeper/Mesh");
}

void check_shoulder(const Check& c) {
  const auto& box = c.scene.container;
  if (box.shoulder_width <= 0) return;
  const double top = 0.5 * c.scene.sleeper.length + box.shoulder_width;
  const double toe = top + box.shoulder_slope * (box.depth + box.fill_height);
  if (toe > 0.5 * box.length)
    c.refuse("Container/Length", "the shoulder's toe lies at x = " + metres(toe) + "; at least " +
                                     metres(2 * toe) + " are needed");
}

void check_loading(const Check& c) {
  const auto& l = c.scene.loading;
  if (l.waveform == "table" && l.table.empty())
    c.refuse("Loading/Waveform", "needs Loading/Table, a CSV file with time_s and load_N");
  if (l.waveform != "table" && !l.table.empty())
    c.refuse("Loading/Table", "is used only with Loading/Waveform = table, not with " + l.waveform);
  const int along = l.push == "lateral" ? dem::kMoveX : dem::kMoveY;
  if (l.push != "none" && !(c.scene.sleeper.freedom & along))
    c.refuse("Loading/Push", std::string("needs ") + (along == dem::kMoveX ? "x" : "y") +
                                 " among Sleeper/Degrees of freedom");
  if (l.push == "lateral" && c.scene.container.half)
    c.refuse("Loading/Push",
             "Container/Half by symmetry mirrors the push as well; use the whole sleeper");
  if (l.waveform != "table" && l.least >= l.largest)
    c.refuse("Loading/Least",
             "less than Loading/Largest = " + shortest(l.largest) + " N is needed");
}

void check_densities(const Check& c) {
  const auto& p = c.scene.packing;
  const double rock = c.scene.grains.density;
  if (p.bulk_density >= rock)
    c.refuse("Packing/Bulk density",
             "a bed has pores: less than Grains/Density = " + shortest(rock) + " kg/m3");
  if (p.target_density >= rock)
    c.refuse("Packing/Target density",
             "a bed has pores: less than Grains/Density = " + shortest(rock) + " kg/m3");
  if (p.folder.empty()) c.refuse("Packing/Folder", "a folder's name is needed");
}

void check_exchange(const Check& c) {
  const auto& n = c.scene.numerics;
  if (n.grain_steps > 1 && n.exchange != "several_steps")
    c.refuse("Numerics/Grain steps per exchange",
             "is used only with Numerics/Exchange = several_steps, not with " + n.exchange);
}

}  // namespace

void check_scene(const Scene& scene, const ParameterValues& values) {
  const Check check{scene, values};
  check_grains(check);
  check_shapes(check);
  check_measures(check);
  check_sleeper(check);
  check_shoulder(check);
  check_densities(check);
  check_gradation(check);
  check_loading(check);
  check_exchange(check);
}

}  // namespace trackbed::apps
