// A sleeper as a Timoshenko beam along x: six motions a node (three shifts, three turns), two-node
// elements whose shape functions solve the static beam exactly and so do not lock (Friedman and
// Kosmatka 1993, Computers & Structures 47:473), consistent mass with rotary inertia.
//
//   bending  EI ψ″ + κGA (w′ − ψ) = ρI ψ̈,  κGA (w″ − ψ′) + q = ρA ẅ   in both planes,
//   axial EA, torsion GJ (Saint-Venant).
//
// The contact surface is the prism of the section around the line; its points move by the line's
// displacement and turn, u + θ × r. All modes of the beam are kept (modal_structure.h).
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "fem/modal_structure.h"

namespace trackbed::fem {

/// A force spread evenly over a length of the beam's top, in its middle.
struct BeamLoad {
  std::string name;
  double centre = 0, length = 0;  ///< along x [m]; length 0: a point
  Vec direction{0, 0, -1};
};

struct BeamParameters {
  std::string name = "Sleeper";
  double low_x = 0, high_x = 0;                ///< ends [m]
  double width = 0, height = 0;                ///< of the section, in y and z [m]
  double base = 0;                             ///< height of its underside [m]
  int elements = 20;                           ///< along x
  int cells_y = 2, cells_z = 1;                ///< of the contact surface
  double young = 0, poisson = 0, density = 0;  ///< [Pa], -, [kg/m3]
  double shear_factor = 5. / 6;                ///< κ
  double bending = 0;        ///< EI of vertical bending instead [N m2]; 0 = E b h³/12
  bool shear_rigid = false;  ///< Euler–Bernoulli, to compare
  double bed = 0;            ///< Winkler springs along the line, vertical [N/m2]
  bool half = false;         ///< low_x is a plane of symmetry
  bool supported = false;    ///< the line's ends are held up and down (not on a plane of symmetry)
  std::vector<BeamLoad> loads;
  Vec gravity{0, 0, 0};  ///< [m/s2]
};

/// The beam at rest. Its gauges are the bending moments M = EI ψ′ [N m] at the nodes along it,
/// sagging positive. \throws InputError: sizes and moduli that are not positive, ν outside (−1, ½),
/// a load beyond its ends.
std::unique_ptr<ModalStructure> make_beam(const BeamParameters&);

}  // namespace trackbed::fem
