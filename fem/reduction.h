// A body of hexahedra reduced to few modes: the motion is sought among the shapes of a basis
// (Rayleigh–Ritz), which the small eigenproblem of that basis turns into oscillators of their own
// (modal_structure.h).
//
//   modal      the lowest normal modes (SLEPc), and residual vectors: what the body's static
//              answer to its loads, its weight and even, linear and sheared pressure on each
//              contact boundary adds to them (Dickens, Nakagawa, Wittbrodt 1997; Rubin 1975 without
//              mass).
//   condensed  the static answers to a unit force at every node of the contact surface (the space
//   of
//              Guyan 1965 and of Craig and Bampton's constraint modes, 1968), and the same normal
//              modes: exact for every static load on the surface. For soft bodies under grains.
//
// Rigid motions are in the basis; momentum is kept. Mass and stiffness are those of the full body,
// so the reduced body is stiffer, never softer, and its energy is the full one's.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fem/elastic_body.h"
#include "fem/modal_structure.h"

namespace trackbed::fem {

enum class Reduction : std::uint8_t { none, condensed, modal };

/// What the reduction costs, against the full body. Deflections are those of the static answer; of
/// a body that is not held, of its elastic part (inertia relief).
struct ReductionReport {
  int unknowns = 0;  ///< of the full body
  int modes = 0;
  std::vector<std::pair<double, double>> frequencies;  ///< lowest elastic [Hz]: full, reduced
  double largest_frequency_error = 0;                  ///< of those, relative
  /// Work of a unit pressure on a contact boundary through the deflection it makes: 1 −
  /// reduced/full, the largest of all contact boundaries.
  double pressure_error = 0;
  /// The same for one force on the boundary's middle node, along its normal: the local dent. The
  /// mesh sets how soft it is; a modal body leaves most of it out.
  double node_error = 0;
};

/// Reduced to `modes` lowest elastic modes and what the method adds. \throws InputError: as
/// ElasticBody; damping that modes do not share (dashpots, unequal Rayleigh constants); a contact
/// surface too large to condense.
std::unique_ptr<ModalStructure> reduced_body(ElasticBodyParameters, Reduction, int modes,
                                             ReductionReport* = nullptr);

}  // namespace trackbed::fem
