// Hard cases: each is a function of shape, law, step and exchange schedule that measures one number
// against its bound. gtest runs one setting of each, the command hard_cases all of them.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "dem/grain/polyhedron.h"

namespace trackbed::hard {

struct Setting {
  std::string shape = "cube";
  std::string law = "stored_energy";
  double share = 0.05;  ///< time step over the stability limit
  std::string schedule = "predicted";
  int grain_steps = 1;  ///< per exchange
};

struct Measured {
  double value = 0, bound = 0;  ///< must be value <= bound; NaN: does not apply to this setting
  bool judged = true;           ///< else only reported: the bound is not promised here
};

/// What of a setting a case depends on.
/// `all_shapes`: polyhedra under the pair laws and round grains under theirs; `level_shapes`: of
/// these the ones that lie flat or on a ball; `pair_laws`: the laws of polyhedra, shapes of its
/// own; `dilated`: dilated polyhedra under the round laws; `once`: nothing.
enum class Over {
  flat_shapes,
  shapes,
  round_shapes,
  all_shapes,
  level_shapes,
  dilated,
  pair_laws,
  schedules,
  once
};

/// A picture of the case: what it measures over what it runs through.
struct Curve {
  std::string x, y;  ///< names and units of the axes
  bool log_x, log_y;
  std::vector<std::array<double, 2>> points;
};

struct Case {
  std::string name, must, unit, damping;
  Over over;
  bool shares;  ///< does the step matter?
  bool slow;
  Measured (*run)(const Setting&);
  Curve (*curve)(const Setting&) = nullptr;
};

const std::vector<Case>& impact_cases();
const std::vector<Case>& edge_cases();
const std::vector<Case>& rest_cases();
const std::vector<Case>& round_cases();
const std::vector<Case>& flat_cases();
const std::vector<Case>& step_cases();
const std::vector<Case>& solid_cases();
const std::vector<Case>& facet_cases();
const std::vector<Case>& saved_cases();
const std::vector<Case>& coupled_cases();
const std::vector<Case>& structure_cases();

/// Cases under one heading.
struct Group {
  const char* name;
  const std::vector<Case>& cases;
};

/// All of them, in the order of the page.
std::vector<Group> groups();
std::vector<Case> all_cases();

/// The settings a case runs over; the first is that of the quick test.
std::vector<Setting> settings(const Case&);

/// "cube", "plate" 1:1:0.1, "needle" 1:0.05:0.05, "tetrahedron", "voronoi", of about edge or width
/// `size` [m]; the first three stand on a flat face.
dem::Polyhedron solid(const std::string& name, double size);

/// Steps of at most this share of the limit carry the promises on energy.
inline constexpr double kPromisedShare = 0.05;
inline bool conservative(const Setting& s) {
  return s.law != "shao2017" && s.share <= kPromisedShare;
}

}  // namespace trackbed::hard
