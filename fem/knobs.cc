#include "fem/knobs.h"

namespace trackbed::fem {
namespace {

Knob order_of(const char* name, const char* path, const char* quantity, const char* needs) {
  Knob knob;
  knob.name = name;
  knob.path = path;
  knob.quantity = quantity;
  knob.meaning = "polynomial degree of the elements; order 1 has incompatible modes";
  knob.rungs = {"1", "2"};
  knob.needs = needs;
  return knob;
}

Knob reduction_of(const char* name, const char* path, const char* quantity, const char* needs) {
  Knob knob;
  knob.name = name;
  knob.path = path;
  knob.quantity = quantity;
  knob.meaning = "shapes among which a reduced body's motion is sought; none is the full body";
  knob.rungs = {"modal", "condensed", "none"};
  knob.needs = needs;
  return knob;
}

Knob modes_of(const char* name, const char* path, const char* quantity, const char* needs) {
  Knob knob;
  knob.name = name;
  knob.path = path;
  knob.quantity = quantity;
  knob.meaning = "lowest elastic modes of a reduced body; higher ones are left out";
  knob.factor = 2;
  knob.cheaper = knob.finer = 1;
  knob.whole = true;
  knob.needs = needs;
  return knob;
}

}  // namespace

std::vector<Knob> fem_knobs() {
  Knob bending;
  bending.name = "sleeper_model";
  bending.path = "Sleeper/Model";
  bending.quantity = "bending_moment";
  bending.meaning = "a rigid sleeper leaves its bending out";
  bending.rungs = {"rigid", "beam", "elastic"};

  Knob cells;
  cells.name = "sleeper_elements";
  cells.path = "Sleeper/Elements";
  cells.quantity = "bending_moment";
  cells.meaning = "cells of the sleeper in x, y and z; displacements converge with h^2 or better";
  cells.factor = 2;
  cells.cheaper = cells.finer = 1;
  cells.whole = true;
  cells.order = 2;
  cells.needs = "Sleeper/Model=elastic";

  Knob soil;
  soil.name = "subgrade_elements";
  soil.path = "Subgrade/Element size";
  soil.quantity = "settlement";
  soil.meaning = "largest edge of a subgrade's element against the grains that press on it";
  soil.factor = 0.5;
  soil.cheaper = soil.finer = 1;
  soil.order = 2;
  soil.needs = "Subgrade/Model!=rigid";
  return {bending,
          cells,
          order_of("sleeper_order", "Sleeper/Order", "bending_moment", "Sleeper/Model=elastic"),
          soil,
          order_of("subgrade_order", "Subgrade/Order", "settlement", "Subgrade/Model!=rigid"),
          reduction_of("sleeper_reduction", "Sleeper/Reduction", "bending_moment",
                       "Sleeper/Model=elastic"),
          modes_of("sleeper_modes", "Sleeper/Modes", "bending_moment", "Sleeper/Reduction!=none"),
          reduction_of("subgrade_reduction", "Subgrade/Reduction", "settlement",
                       "Subgrade/Model=layered_elastic"),
          modes_of("subgrade_modes", "Subgrade/Modes", "settlement", "Subgrade/Reduction!=none")};
}

}  // namespace trackbed::fem
