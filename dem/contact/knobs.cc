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
  return {modulus, packing, law};
}

}  // namespace trackbed::dem
