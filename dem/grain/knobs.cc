#include "dem/knobs.h"

namespace trackbed::dem {

std::vector<Knob> grain_knobs() {
  Knob shape;
  shape.name = "shape";
  shape.path = "Grains/Shape";
  shape.quantity = "settlement";
  shape.meaning = "simpler grains roll and interlock otherwise; round ones touch under Hertz's law";
  shape.rungs = {"sphere", "clump", "dilated", "polyhedron"};

  Knob spheres;
  spheres.name = "clump_spheres";
  spheres.path = "Grains/Clump least radius";
  spheres.quantity = "settlement";
  spheres.meaning = "smaller spheres fill a stone's corners; their number grows with its inverse";
  spheres.factor = 0.5;
  spheres.cheaper = spheres.finer = 1;
  spheres.needs = "Grains/Shape=clump";

  Knob rounding;
  rounding.name = "dilation";
  rounding.path = "Grains/Dilation";
  rounding.quantity = "settlement";
  rounding.meaning = "rounding of a dilated grain; a smaller one bears less before cores meet";
  rounding.factor = 0.5;
  rounding.cheaper = rounding.finer = 1;
  rounding.needs = "Grains/Shape=dilated";

  Knob library;
  library.name = "library_size";
  library.path = "Grains/Library size";
  library.quantity = "porosity";
  library.meaning = "few shapes repeat themselves in the bed";
  library.factor = 4;
  library.cheaper = 2;
  library.whole = true;
  return {shape, spheres, rounding, library};
}

}  // namespace trackbed::dem
