// The subgrade models by name. A model is one file in this folder: a function that builds the
// structure, its parameters with units, its documentation, and one registration line. No list is
// edited; the model shows up in the parameter file, in `trackbed parameters` and in the docs.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/parameter.h"
#include "fem/elastic_body.h"
#include "fem/materials/stress_model.h"
#include "fem/point_bed.h"
#include "fem/reduction.h"

namespace trackbed::fem {

/// Where a subgrade lies and how it is meshed and held: the same for all models.
struct SubgradeSite {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  ///< plan [m]
  double top = 0;                                       ///< height of its surface [m]
  double element_size = 0.1;                            ///< wanted edge length [m]
  int order = 1;
  bool periodic_x = false, periodic_y = false;  ///< else rollers at the sides
  bool mirror_x = false;                        ///< x_low is a plane of symmetry: always rollers
  bool newmark = false;
  double rho_inf = 0.9;
  TimeScheme scheme = TimeScheme::automatic;
  SolverKind solver = SolverKind::automatic;
  Reduction reduction = Reduction::none;
  int modes = 20;                                          ///< of a reduced body
  bool absorbing_sides = false, absorbing_bottom = false;  ///< instead of rollers and a fixed base
  RayleighDamping damping;                                 ///< of all materials

  bool damped() const { return damping.mass > 0 || damping.stiffness > 0; }
};

/// What the user wrote, key -> text; every key of the model is there (defaults filled in).
using Values = std::map<std::string, std::string>;

struct SubgradeModel {
  std::string name;           ///< the word in the parameter file
  std::string documentation;  ///< equation, symbols, source, when to use it
  std::vector<Parameter> parameters;
  std::function<std::unique_ptr<Structure>(const SubgradeSite&, const Values&)> build;
  /// Instead of `build`, for a material with history: its stress model. The body is then a box of
  /// the thickness that the key "Depth" says.
  std::function<std::shared_ptr<const StressModel>(const Values&)> stress = {};
};

/// All models, by name.
const std::map<std::string, SubgradeModel>& subgrade_models();

/// Builds by name; missing keys take their defaults. \throws InputError: unknown model (the names
/// there are), unknown key, not a number, out of range.
std::unique_ptr<Structure> make_subgrade(const std::string& model, const SubgradeSite&, Values);

/// The stress model of a subgrade that has one, for tests of a material point; else null.
/// \throws InputError as make_subgrade.
std::shared_ptr<const StressModel> stress_model(const std::string& model, Values);

/// One line at the end of a model's file: `const RegisterSubgrade here{{...}};`
struct RegisterSubgrade {
  explicit RegisterSubgrade(SubgradeModel);
};

/// For the models: a number of the user's, checked by make_subgrade already.
double number(const Values&, const std::string& key);
/// The box under the site with its sides held; the model adds layers and materials.
ElasticBodyParameters box_under(const SubgradeSite&);
/// The body with the site's time scheme, solver, absorbing boundaries, damping and reduction: what
/// a model's build returns.
std::unique_ptr<Structure> make_body(const SubgradeSite&, ElasticBodyParameters);
/// The bed of points on the site; the model adds stiffness, dashpot, mass.
PointBedParameters points_under(const SubgradeSite&);
/// Cells over a thickness [m] for the site's wanted size.
int cells_over(const SubgradeSite&, double thickness);

}  // namespace trackbed::fem
