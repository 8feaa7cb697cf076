#include <cmath>

#include "ladder.h"
#include "two_masses.h"

namespace trackbed::study {
namespace {

// Processor time of a grain step of a small bed on an elastic block, and structure steps in it.
struct Cost {
  double seconds, structure_steps;
};
Cost cost(const coupling::Exchange& e) {
  coupling::World w = coupling::bed(3, 3);
  w.exchange = e;
  const double dt = 2e-6;  // within the explicit limit, and 20 of them within that of an exchange
  const dem::StepContext c = coupling::context(dt, {0, 0, -9.81});
  coupling::start(w, c);
  const int exchanges = 400 / e.grain_steps;
  const std::clock_t begun = std::clock();
  coupling::run(w, c, exchanges);
  const double seconds = double(std::clock() - begun) / CLOCKS_PER_SEC;
  const long solves = e.schedule == coupling::Schedule::iterated ? exchanges + w.times.iterations
                                                                 : static_cast<long>(exchanges);
  return {seconds / (exchanges * e.grain_steps), double(solves) / (exchanges * e.grain_steps)};
}

Ladder schedules() {
  Ladder l{"exchange schedule",
           "schedule",
           "growth of amplitude per step of two masses at omega dt = 0.1, against 0",
           "structure steps a grain step",
           "a grain step of 27 grains on 50 elements",
           "",
           {}};
  for (const char* name : {"lagged", "predicted", "explicit", "iterated"}) {
    const coupling::Exchange e = coupling::exchange(name);
    const Cost c = cost(e);
    l.rungs.push_back({name, 0, std::abs(coupling::growth(.1, e)), c.seconds, c.structure_steps});
  }
  return l;
}

Ladder several_steps() {
  Ladder l{"sub-cycling",
           "grain steps per exchange",
           "growth of amplitude per grain step of two masses at omega dt = 0.1, against 0 (damped "
           "from 5 to 20)",
           "structure steps a grain step",
           "a grain step of 27 grains on 50 elements",
           "",
           {}};
  for (const int n : {20, 10, 5, 2, 1}) {
    const coupling::Exchange e =
        n > 1 ? coupling::exchange("several_steps", n) : coupling::exchange("predicted");
    const Cost c = cost(e);
    l.rungs.push_back({std::to_string(n), double(n), std::abs(coupling::growth(.1, e)), c.seconds,
                       c.structure_steps});
  }
  return l;
}

Ladder step(const char* schedule, const char* theory) {
  Ladder l{std::string("step, ") + schedule,
           "omega dt",
           "growth of amplitude per step of two masses, against 0",
           "steps a period",
           "",
           theory,
           {}};
  for (const double W : {.4, .2, .1, .05}) {
    char name[20];
    std::snprintf(name, sizeof name, "%g", W);
    l.rungs.push_back({name, W, std::abs(coupling::growth(W, coupling::exchange(schedule))), 0,
                       std::round(2 * M_PI / W)});
  }
  return l;
}

}  // namespace

std::vector<Ladder> exchange_ladders() {
  return {schedules(), several_steps(), step("predicted", "4"), step("lagged", "2")};
}

}  // namespace trackbed::study
