#include "dem/grading/grain_form.h"

#include "base/error.h"
#include "dem/grain/shape_indices.h"

namespace trackbed::dem {

std::vector<GrainForm> grain_forms(const std::vector<GrainShape>& shapes) {
  for (const GrainShape& shape : shapes)
    if (!(shape.sieve_size > 0)) throw InputError("grain form: a grain is not sized");
  std::vector<GrainForm> forms(shapes.size());
#pragma omp parallel for schedule(dynamic, 8)
  for (int k = 0; k < int(shapes.size()); ++k) {
    const ShapeIndices s = shape_indices(shapes[k].body);
    const bool needle = s.diameter > 1.8 * shapes[k].sieve_size;
    const bool flaky = s.width < 0.6 * shapes[k].sieve_size;
    forms[k] = needle ? (flaky ? GrainForm::needle_and_flaky : GrainForm::needle)
                      : (flaky ? GrainForm::flaky : GrainForm::ordinary);
  }
  return forms;
}

}  // namespace trackbed::dem
