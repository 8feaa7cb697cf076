#include "coupling/knobs.h"

namespace trackbed::coupling {

std::vector<Knob> coupling_knobs() {
  Knob schedule;
  schedule.name = "exchange";
  schedule.path = "Numerics/Exchange";
  schedule.quantity = "energy_drift";
  schedule.meaning = "schedule of forces and motion between grains and structures";
  schedule.rungs = {"lagged", "predicted", "iterated"};

  Knob interval;
  interval.name = "exchange_interval";
  interval.path = "Numerics/Grain steps per exchange";
  interval.quantity = "settlement";
  interval.meaning = "grain steps for each step of the structures";
  interval.factor = 0.5;
  interval.cheaper = 3;
  interval.finer = 3;
  interval.whole = true;
  interval.with = {"Numerics/Exchange=several_steps"};
  interval.needs = "Numerics/Exchange!=iterated";
  return {schedule, interval};
}

}  // namespace trackbed::coupling
