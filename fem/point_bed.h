// A bed of points that move vertically and know nothing of each other: per area A of a node
//
//   m A ü + c A u̇ + k A u = F_z
//
// (Winkler 1867 with c = 0, Kelvin–Voigt with c). Horizontal forces are taken by the ground. In
// time by generalised-α or Newmark, one division a node.
#pragma once
#include <memory>

#include "fem/structure.h"

namespace trackbed::fem {

struct PointBedParameters {
  double x_low = 0, x_high = 1, y_low = 0, y_high = 1;  ///< plan [m]
  double top = 0;                                       ///< height [m]
  int cells_x = 1, cells_y = 1;
  bool periodic_x = false, periodic_y = false;
  double stiffness = 0;  ///< k, modulus of subgrade reaction [N/m3] > 0
  double dashpot = 0;    ///< c [N s/m3] >= 0
  double mass = 0;       ///< m, soil that moves along [kg/m2] > 0
  bool newmark = false;
  double rho_inf = 0.9;
};

/// \throws InputError for values out of range.
std::unique_ptr<Structure> make_point_bed(const PointBedParameters&);

}  // namespace trackbed::fem
