// A ladder: one numerical choice from cheap to exact, its error against an exact value and its
// cost.
#pragma once
#include <ctime>
#include <string>
#include <vector>

namespace trackbed::study {

struct Rung {
  std::string name;
  double size = 0;   ///< what the error is fitted against (a step, a cell, 1/number); 0: not fitted
  double error = 0;  ///< relative, unless the ladder says otherwise
  double seconds = 0;  ///< processor time
  double count = 0;    ///< of Ladder::counted
};

struct Ladder {
  std::string name, knob;
  std::string error;    ///< of what, against which exact value
  std::string counted;  ///< what Rung::count counts
  std::string cost;     ///< what Rung::seconds is the time of
  std::string theory;   ///< order that theory gives; empty: none
  std::vector<Rung> rungs;
};

/// p of error ~ size^p by least squares over the logarithms; NaN with fewer than two rungs.
double fitted_order(const Ladder&);

/// Mean processor time [s] of a call that is repeated for a twentieth of a second.
template <class F>
double seconds_of(F&& call) {
  const std::clock_t start = std::clock();
  int calls = 0;
  double elapsed = 0;
  do {
    call();
    ++calls;
    elapsed = double(std::clock() - start) / CLOCKS_PER_SEC;
  } while (elapsed < 0.05);
  return elapsed / calls;
}

std::vector<Ladder> motion_ladders();    ///< time step: impact, free rotation
std::vector<Ladder> grain_ladders();     ///< sieve methods, slices, spheres, cells
std::vector<Ladder> element_ladders();   ///< h and p, locking in bending and in volume
std::vector<Ladder> body_ladders();      ///< reduction, reflection, size of the domain
std::vector<Ladder> exchange_ladders();  ///< schedules, sub-cycling

}  // namespace trackbed::study
