#include "dem/knobs.h"

namespace trackbed::dem {

std::vector<Knob> packing_knobs() {
  Knob rest;
  rest.name = "rest";
  rest.path = "Packing/Quiet";
  rest.quantity = "porosity";
  rest.meaning = "kinetic energy below which a stage of the packing counts as at rest";
  rest.factor = 0.1;
  rest.cheaper = rest.finer = 1;

  Knob zones;
  zones.name = "zones";
  zones.path = "Zones/Use";
  zones.quantity = "settlement";
  zones.meaning = "coarser, simpler grains away from the sleeper, or fine ones everywhere";
  zones.rungs = {"true", "false"};

  Knob margin;
  margin.name = "zone_margin";
  margin.path = "Zones/Margin";
  margin.quantity = "settlement";
  margin.meaning = "how far from the sleeper the coarse grains begin";
  margin.factor = 2;
  margin.cheaper = margin.finer = 1;
  margin.needs = "Zones/Use=true";
  return {rest, zones, margin};
}

}  // namespace trackbed::dem
