#include <cmath>

#include "known/flip_period.h"
#include "known/sphere_impact.h"
#include "ladder.h"

namespace trackbed::study {

std::vector<Ladder> motion_ladders() {
  Ladder duration{"hertz impact, duration",
                  "steps a contact",
                  "duration of the contact against Hertz",
                  "steps of a contact",
                  "an impact",
                  "2",
                  {}};
  Ladder rebound{"hertz impact, rebound",
                 "steps a contact",
                 "rebound speed against 1 (elastic)",
                 "steps of a contact",
                 "an impact",
                 "5/2",
                 {}};
  for (const int steps : {12, 25, 50, 100, 200, 400, 800}) {
    dem::ImpactErrors e{};
    const double seconds = seconds_of([&] { e = dem::impact_errors(steps); }) / 8;
    duration.rungs.push_back({std::to_string(steps), 1. / steps, e.duration, seconds, 1. * steps});
    rebound.rungs.push_back({std::to_string(steps), 1. / steps, e.rebound, seconds, 1. * steps});
  }
  Ladder flip{"free rotation",
              "time step [s]",
              "flip period against 39.105734197 s",
              "steps a period",
              "two periods",
              "2",
              {}};
  for (const double dt : {.16, .08, .04, .02, .01, .005}) {
    double period = 0;
    const double seconds = seconds_of([&] { period = dem::flip_period(dt); });
    char name[20];
    std::snprintf(name, sizeof name, "%g", dt);
    flip.rungs.push_back({name, dt, std::abs(period / dem::kFlipPeriod - 1), seconds,
                          std::round(dem::kFlipPeriod / dt)});
  }
  return {duration, rebound, flip};
}

}  // namespace trackbed::study
