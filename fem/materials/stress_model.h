// A material whose stress depends on what it has been through, a block of quadrature points at a
// time. Small strains, tension positive, stresses in pascal; components xx, yy, zz, yz, xz, xy,
// shear strains as angles (twice the tensor's).
//
// The body (fem/history_cells.h) keeps the history of every point, gives it to evaluate() at the
// start of a step, takes it back at its end, and puts it into checkpoints: a model only says how
// many numbers a point remembers.
#pragma once
#include <array>
#include <vector>

namespace trackbed::fem {

using Voigt = std::array<double, 6>;
using Tangent = std::array<double, 36>;  ///< d stress_i / d strain_j at 6 i + j [Pa]

struct StressInputs {
  std::vector<double> depth;    ///< under the top of the body [m]
  std::vector<Voigt> strain;    ///< at the end of the step, from the state in situ [-]
  std::vector<double> history;  ///< at its start, history() numbers a point; zeros in situ
};

/// All vectors have the points' size when evaluate() is called.
struct StressOutputs {
  std::vector<Voigt> stress;       ///< at the end of the step, the one in situ included [Pa]
  std::vector<double> history;     ///< at the end of the step
  std::vector<double> stored;      ///< elastic energy [J/m3]
  std::vector<double> dissipated;  ///< in this step [J/m3]
  bool want_tangent = false;
  std::vector<Tangent> tangent;  ///< consistent with the step, if wanted
};

class StressModel {
 public:
  virtual ~StressModel() = default;
  virtual int history() const = 0;     ///< numbers that a point remembers
  virtual double density() const = 0;  ///< [kg/m3]
  /// Points of one cell; one call a cell, none a point.
  virtual void evaluate(const StressInputs&, StressOutputs&) const = 0;
};

}  // namespace trackbed::fem
