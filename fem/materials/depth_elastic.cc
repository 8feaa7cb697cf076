#include "base/error.h"
#include "fem/materials/model.h"
#include "fem/text.h"

namespace trackbed::fem {
namespace {

struct DepthElastic final : MaterialModel {
  double top, slope, poisson, density;
  DepthElastic(double e, double s, double nu, double rho)
      : top(e), slope(s), poisson(nu), density(rho) {}
  void evaluate(const MaterialInputs& in, MaterialOutputs& out) const override {
    for (std::size_t q = 0; q < in.depth.size(); ++q) {
      out.young[q] = top + slope * in.depth[q];
      out.poisson[q] = poisson;
      out.density[q] = density;
    }
  }
};

}  // namespace

std::shared_ptr<const MaterialModel> depth_elastic(const char* name, double young_top, double slope,
                                                   double poisson, double density) {
  check_elastic(name, young_top, poisson, density);
  if (!(slope >= 0))
    throw InputError(
        text(name, ": growth of the modulus with depth ", slope, " Pa/m, must be 0 or more"));
  return std::make_shared<DepthElastic>(young_top, slope, poisson, density);
}

}  // namespace trackbed::fem
