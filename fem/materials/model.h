// What a material tells the elements, a block of quadrature points at a time.
#pragma once
#include <memory>
#include <vector>

#include "fem/structure.h"

namespace trackbed::fem {

/// Points of one cell, and how deep they lie under the top of the body.
struct MaterialInputs {
  std::vector<Vec> points;    ///< [m]
  std::vector<double> depth;  ///< [m], 0 at the highest point of the body, positive downwards
};

/// Isotropic small-strain elasticity at those points.
struct MaterialOutputs {
  std::vector<double> young;    ///< Young's modulus E [Pa] > 0
  std::vector<double> poisson;  ///< Poisson's ratio ν [-], -1 < ν < ½
  std::vector<double> density;  ///< ρ [kg/m3] > 0
};

/// A material: one virtual call a cell. `out` has the size of `in` when called.
class MaterialModel {
 public:
  virtual ~MaterialModel() = default;
  virtual void evaluate(const MaterialInputs& in, MaterialOutputs& out) const = 0;
};

/// \throws InputError unless E > 0, -1 < ν < ½, ρ > 0; `name` is in the text.
void check_elastic(const char* name, double young, double poisson, double density);

/// E, ν, ρ everywhere the same. \throws InputError unless E > 0, -1 < ν < ½, ρ > 0; `name` is in
/// the text.
std::shared_ptr<const MaterialModel> uniform_elastic(const char* name, double young, double poisson,
                                                     double density);

/// E(depth) = E_top + slope·depth [Pa], ν, ρ. \throws as above, slope ≥ 0.
std::shared_ptr<const MaterialModel> depth_elastic(const char* name, double young_top, double slope,
                                                   double poisson, double density);

}  // namespace trackbed::fem
