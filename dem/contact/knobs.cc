#include "dem/knobs.h"

namespace trackbed::dem {

std::vector<Knob> contact_knobs() {
  Knob modulus;
  modulus.name = "contact_modulus";
  modulus.path = "Contact/Contact modulus";
  modulus.quantity = "settlement";
  modulus.meaning = "softer grains allow larger steps (time ~ E^-1/2) and overlap more";
  modulus.factor = 4;
  modulus.cheaper = 2;
  modulus.finer = 1;

  Knob packing = modulus;
  packing.name = "packing_modulus";
  packing.path = "Contact/Packing modulus";
  packing.quantity = "porosity";
  packing.meaning = "softer grains while packing";
  packing.cheaper = 1;

  Knob law;
  law.name = "contact_law";
  law.path = "Contact/Law";
  law.quantity = "energy_drift";
  law.meaning = "normal contact law; the last one is the gradient of a stored energy";
  law.rungs = {"shao2017", "stored_energy"};

  Knob round;
  round.name = "round_law";
  round.path = "Contact/Round law";
  round.quantity = "stiffness";
  round.meaning = "law of round grains, from a constant stiffness to Hertz's and Mindlin's";
  round.rungs = {"linear", "sun2015", "hertz_mindlin"};
  round.needs = "Grains/Shape!=polyhedron";

  Knob flat = round;
  flat.name = "flat_faces";
  flat.meaning = "faces of dilated grains touch at a point, or answer by the area they meet on";
  flat.rungs = {"hertz_mindlin", "hertz_flat"};
  flat.needs = "Grains/Shape=dilated";
  return {modulus, packing, law, round, flat};
}

}  // namespace trackbed::dem
