#include <cmath>

#include "known/half_space.h"
#include "known/reduced_response.h"
#include "known/reflecting_rod.h"
#include "ladder.h"

namespace trackbed::study {
namespace {

using namespace fem;

Ladder reduction(const char* name, const ElasticBodyParameters& body, Reduction method) {
  Ladder l{name,
           "modes asked for",
           "surface's place against the full body's over 1000 steps, largest of all",
           "modes of the basis",
           "a step of the structure",
           "",
           {}};
  known::Deviation d{};
  for (const int modes : {1, 5, 10, 20, 40, 80}) {
    d = known::deviation(body, method, modes);
    l.rungs.push_back({std::to_string(modes), 0, d.error, d.step, double(d.modes)});
  }
  l.rungs.push_back({"full body", 0, 0, d.full_step, double(ElasticBody(body).unknowns())});
  return l;
}

// Energy that comes back from the end of a rod; without the end none would.
Ladder impedance() {
  Ladder l{"reflection, dashpots",
           "impedance of the boundary over rho c",
           "energy that comes back over the pulse's, against ((1 - r)/(1 + r))^2 in brackets",
           "cells",
           "a pulse there and back",
           "",
           {}};
  for (const double r : {0., .2, .5, .8, .9, 1.}) {
    known::Reflection e{};
    const double seconds = seconds_of([&] { e = known::reflection(r, 200); });
    char name[40];
    std::snprintf(name, sizeof name, "%g (%.3g)", r, std::pow((1 - r) / (1 + r), 2));
    l.rungs.push_back({name, 0, e.energy, seconds, 200});
  }
  return l;
}

Ladder matched() {
  Ladder l{"reflection, matched",
           "cells of the rod",
           "energy that comes back from a matched boundary over the pulse's, against 0",
           "cells",
           "a pulse there and back",
           "4",
           {}};
  for (const int cells : {25, 50, 100, 200, 400}) {
    known::Reflection e{};
    const double seconds = seconds_of([&] { e = known::reflection(1, cells); });
    l.rungs.push_back({std::to_string(cells), 1. / cells, e.energy, seconds, double(cells)});
  }
  return l;
}

Ladder domain() {
  Ladder l{"size of the domain",
           "radii of the loaded disc to the block's bottom and sides",
           "mean settlement under the disc against Love's half-space",
           "unknowns",
           "assembly and solve",
           "1 (to the error of the cells)",
           {}};
  for (const double size : {3., 6., 12., 24., 48.}) {
    known::HalfSpace h{};
    const double seconds = seconds_of([&] { h = known::half_space_under_a_disc(size); });
    char name[20];
    std::snprintf(name, sizeof name, "%g", size);
    l.rungs.push_back(
        {name, 1 / size, std::abs(h.mean / 2.234535e-3 - 1), seconds, double(h.unknowns)});
  }
  return l;
}

}  // namespace

std::vector<Ladder> body_ladders() {
  return {reduction("reduction, sleeper by modes", known::sleeper(), Reduction::modal),
          reduction("reduction, soil condensed", known::soil(), Reduction::condensed), impedance(),
          matched(), domain()};
}

}  // namespace trackbed::study
