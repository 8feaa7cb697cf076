#include "dem/knobs.h"

#include "dem/grading/sieve_size.h"

namespace trackbed::dem {

std::vector<Knob> grading_knobs() {
  Knob method;
  method.name = "sieve_method";
  method.path = "Grains/Sieve method";
  method.quantity = "porosity";
  method.meaning = "puts grains into their sieve class: a wrong size is another gradation";
  method.rungs = sieve_method_names();
  return {method};
}

}  // namespace trackbed::dem
