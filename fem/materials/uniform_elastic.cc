#include <algorithm>

#include "base/error.h"
#include "fem/materials/model.h"
#include "fem/text.h"

namespace trackbed::fem {

void check_elastic(const char* name, double young, double poisson, double density) {
  if (!(young > 0))
    throw InputError(text(name, ": Young's modulus ", young, " Pa, must be positive"));
  if (!(poisson > -1 && poisson < 0.5))
    throw InputError(text(name, ": Poisson's ratio ", poisson, ", must lie between -1 and 0.5"));
  if (!(density > 0))
    throw InputError(text(name, ": density ", density, " kg/m3, must be positive"));
}

namespace {

struct UniformElastic final : MaterialModel {
  double young, poisson, density;
  UniformElastic(double e, double nu, double rho) : young(e), poisson(nu), density(rho) {}
  void evaluate(const MaterialInputs&, MaterialOutputs& out) const override {
    std::fill(out.young.begin(), out.young.end(), young);
    std::fill(out.poisson.begin(), out.poisson.end(), poisson);
    std::fill(out.density.begin(), out.density.end(), density);
  }
};

}  // namespace

std::shared_ptr<const MaterialModel> uniform_elastic(const char* name, double young, double poisson,
                                                     double density) {
  check_elastic(name, young, poisson, density);
  return std::make_shared<UniformElastic>(young, poisson, density);
}

}  // namespace trackbed::fem
