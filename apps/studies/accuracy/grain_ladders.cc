#include <algorithm>
#include <cmath>

#include "dem/grading/sieve_size.h"
#include "dem/grain/dilated.h"
#include "dem/grain/voronoi.h"
#include "known/dilated_cells.h"
#include "known/filled_stones.h"
#include "ladder.h"

namespace trackbed::study {
namespace {

using namespace dem;

// Mean over Voronoi grains; the exact size brackets itself: its error is the bracket's width.
Ladder sieve_methods() {
  Ladder l{"sieve size",
           "method",
           "mean of |size / exact size - 1|, 200 Voronoi grains",
           "directions searched a grain",
           "a grain",
           "",
           {}};
  VoronoiParameters v;
  v.count = 200;
  const auto grains = voronoi_grains(v);
  std::vector<double> exact, bracket;
  double evaluations = 0;
  const double exact_time = seconds_of([&] {
                              exact.clear(), bracket.clear();
                              evaluations = 0;
                              for (const Polyhedron& g : grains) {
                                const ExactSieveSize s = exact_sieve_size(g);
                                exact.push_back(s.size);
                                bracket.push_back(1 - s.lower_bound / s.size);
                                evaluations += s.evaluations;
                              }
                            }) /
                            v.count;
  for (const std::string& name : sieve_method_names()) {
    if (name == "exact") break;
    double error = 0;
    const double seconds = seconds_of([&] {
      error = 0;
      for (int k = 0; k < v.count; ++k)
        error += std::abs(sieve_size(grains[k], parse_sieve_method(name)) / exact[k] - 1) / v.count;
    });
    l.rungs.push_back({name, 0, error, seconds / v.count, 0});
  }
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4}) {
    double error = 0, searched = 0;
    const double seconds = seconds_of([&] {
      error = searched = 0;
      for (int k = 0; k < v.count; ++k) {
        const ExactSieveSize s = exact_sieve_size(grains[k], tolerance);
        error += std::abs(s.size / exact[k] - 1) / v.count;
        searched += double(s.evaluations) / v.count;
      }
    });
    char name[30];
    std::snprintf(name, sizeof name, "exact to %g", tolerance);
    l.rungs.push_back({name, 0, error, seconds / v.count, searched});
  }
  double mean = 0;
  for (const double b : bracket) mean += b / v.count;
  l.rungs.push_back({"exact", 0, mean, exact_time, evaluations / v.count});
  return l;
}

Ladder slices() {
  Ladder l{"slices of a clump",
           "slices over the least sphere",
           "volume against the union's closed form, mean of 8 clumps",
           "spheres",
           "a clump",
           "2",
           {}};
  const auto clumps = known::fillings(.007, 8);  // of Jin's stones
  for (const int n : {3, 6, 12, 25, 50, 100, 200, 400}) {
    double error = 0, spheres = 0;
    const double seconds = seconds_of([&] {
      error = spheres = 0;
      for (const auto& clump : clumps) {
        const double exact = mass_properties(clump).volume;
        error += std::abs(sliced_volume(clump, n) / exact - 1) / clumps.size();
        spheres += double(clump.size()) / clumps.size();
      }
    });
    const double closed = seconds_of([&] {
      for (const auto& clump : clumps) mass_properties(clump);
    });
    l.rungs.push_back({std::to_string(n), 1. / n, error,
                       std::max(0., seconds - closed) / clumps.size(), spheres});
    if (n == 400) l.rungs.push_back({"closed form", 0, 0, closed / clumps.size(), spheres});
  }
  return l;
}

Ladder spheres() {
  Ladder l{"spheres of a clump",
           "least radius R_lim [mm]",
           "inertia (trace) against the stone's, mean of 8 of Jin's stones",
           "spheres",
           "a filling",
           "",
           {}};
  for (const double least : {.014, .010, .007, .005, .0035, .0025, .002}) {
    std::vector<std::vector<Sphere>> clumps;
    const double seconds = seconds_of([&] { clumps = known::fillings(least, 8); });
    const known::Filling f = known::missing_inertia(clumps);
    char name[20];
    std::snprintf(name, sizeof name, "%g", 1000 * least);
    l.rungs.push_back({name, least, f.error, seconds / 8, f.spheres});
  }
  return l;
}

// The unit cube dilated by 1/5.
Ladder cells() {
  Ladder l{"dilated grain",
           "cells along an edge",
           "volume and inertia of a dilated cube against V + S r + M r^2 + 4/3 pi r^3 and its like",
           "cells",
           "a grain",
           "",
           {}};
  const double r = .2, volume = 1 + 6 * r + 3 * M_PI * r * r + 4 / 3. * M_PI * r * r * r;
  const DilatedPolyhedron body{make_box({1, 1, 1}), r};
  const double inertia = mass_properties(body).inertia(0, 0);
  for (const int n : {8, 16, 32, 64, 128}) {
    double error = 0, seconds = 0;
    for (int k = 0; k < 4; ++k) {  // counting jumps: mean over numbers nearby
      known::CellSum sum;
      seconds += seconds_of([&] { sum = known::dilated_cube_by_cells(r, n + k); }) / 4;
      error += (std::abs(sum.volume / volume - 1) + std::abs(sum.inertia / inertia - 1)) / 8;
    }
    l.rungs.push_back({std::to_string(n), 1. / n, error, seconds, std::pow(n + 1.5, 3)});
  }
  const double seconds = seconds_of([&] { mass_properties(body); });
  l.rungs.push_back(
      {"Steiner", 0, std::abs(mass_properties(body).volume / volume - 1), seconds, 0});
  return l;
}

}  // namespace

std::vector<Ladder> grain_ladders() { return {sieve_methods(), slices(), spheres(), cells()}; }

}  // namespace trackbed::study
