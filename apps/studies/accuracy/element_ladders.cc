#include <cmath>

#include "fem/elastic_body.h"
#include "known/bent_cantilever.h"
#include "known/manufactured_solution.h"
#include "known/thick_cylinder.h"
#include "ladder.h"

namespace trackbed::study {
namespace {

using namespace fem;

struct Kind {
  const char* name;
  int order;
  Element element;
};
constexpr Kind kStandard{"Q1", 1, Element::standard},
    kIncompatible{"Q1 with incompatible modes", 1, Element::incompatible},
    kMeanDilatation{"Q1 with mean dilatation", 1, Element::b_bar},
    kQuadratic{"Q2", 2, Element::standard},
    kQuadraticMean{"Q2 with mean dilatation", 2, Element::b_bar};

Ladder manufactured(const Kind& kind, const std::vector<int>& cells) {
  Ladder l{std::string("elements, ") + kind.name,
           "cells along an edge",
           "L2 norm of the error of a manufactured solution (no unit)",
           "unknowns",
           "assembly and solve",
           std::to_string(kind.order + 1),
           {}};
  for (const int n : cells) {
    known::Errors e{};
    const double seconds =
        seconds_of([&] { e = known::manufactured_error(kind.order, kind.element, n); });
    l.rungs.push_back({std::to_string(n), 1. / n, e.value, seconds, double(e.unknowns)});
  }
  return l;
}

Ladder bending(const Kind& kind) {
  Ladder l{std::string("bending, ") + kind.name,
           "cells along x over the height",
           "tip deflection against Timoshenko's beam",
           "unknowns",
           "assembly and solve",
           kind.order == 1 ? "2" : "",
           {}};
  for (const int n : {1, 2, 4}) {
    known::Bending e{};
    const double seconds =
        seconds_of([&] { e = known::bent_cantilever(kind.order, kind.element, n); });
    l.rungs.push_back({std::to_string(13 * n) + " x " + std::to_string(n), 1. / n, e.error, seconds,
                       double(e.unknowns)});
  }
  return l;
}

Ladder cylinder(const Kind& kind) {
  Ladder l{std::string("near-incompressible, ") + kind.name,
           "cells along the radius",
           "inner displacement of a thick cylinder at a Poisson ratio of .4999 against Lame's",
           "cells",
           "reading the mesh, assembly and solve",
           "",
           {}};
  for (const int n : {5, 10, 20}) {
    double ratio = 0;
    const double seconds =
        seconds_of([&] { ratio = known::cylinder_ratio(kind.order, kind.element, n, 2 * n); });
    l.rungs.push_back({std::to_string(n), 1. / n, std::abs(ratio - 1), seconds, 2. * n * n});
  }
  return l;
}

}  // namespace

std::vector<Ladder> element_ladders() {
  known::manufactured_error(1, Element::standard, 2);  // libraries set up: no rung pays for it
  return {manufactured(kStandard, {4, 8, 16}),
          manufactured(kIncompatible, {4, 8, 16}),
          manufactured(kQuadratic, {2, 4, 8}),
          bending(kStandard),
          bending(kIncompatible),
          bending(kQuadratic),
          cylinder(kStandard),
          cylinder(kMeanDilatation),
          cylinder(kIncompatible),
          cylinder(kQuadratic),
          cylinder(kQuadraticMean)};
}

}  // namespace trackbed::study
