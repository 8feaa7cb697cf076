#include "dem/knobs.h"

namespace trackbed::dem {

std::vector<Knob> motion_knobs() {
  Knob step;
  step.name = "time_step";
  step.path = "Numerics/Margin";
  step.quantity = "settlement";
  step.meaning = "time step while loading, as a share of the stability limit (velocity Verlet)";
  step.factor = 0.5;
  step.cheaper = 2;
  step.finer = 2;
  step.order = 2;

  Knob packing = step;
  packing.name = "packing_step";
  packing.path = "Numerics/Packing margin";
  packing.quantity = "porosity";
  packing.meaning = "time step while packing, as a share of the stability limit";
  packing.cheaper = 1;
  return {step, packing};
}

}  // namespace trackbed::dem
