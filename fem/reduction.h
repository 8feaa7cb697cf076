// A body of hexahedra reduced to few modes: the motion is sought among the shapes of a basis
// (Rayleigh–Ritz), which the small eigenproblem of that basis turns into oscillators of their own
// (modal_structure.h).
//
//   modal      the lowest normal modes (SLEPc), and residual vectors: what the body's static
//              answer to its loads, its weight and even, linear and sheared pressure on each
//              contact boundary adds to them (Dickens, Nakagawa, Wittbrodt 1997; Rubin 1975 without
//              mass).
//   condensed  the static answers to a unit force at every node of the contact surface (the space
//              of Guyan 1965 and of Craig and Bampton's constraint modes, 1968), and the same
//              normal modes: exact for every static load on the surface. For soft bodies under
//              grains.
//
// Rigid motions are in the basis; momentum is kept. Mass and stiffness are those of the full body,
// so the reduced body is stiffer, never softer, and its energy is the full one's.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "fem/elastic_body.h"
#include "fem/modal_structure.h"

namespace trackbed::fem {

enum class Reduction : std::uint8_t { none, condensed, modal };

/// By name; for a parameter whose choices are checked already.
Reduction reduction_of(const std::string& name);

/// Reduced to `modes` lowest elastic modes and what the method adds. \throws InputError: as
/// ElasticBody; damping that modes do not share (dashpots, unequal Rayleigh constants); a contact
/// surface too large to condense. Its model() holds the report.
std::unique_ptr<ModalStructure> reduced_body(ElasticBodyParameters, Reduction, int modes);

}  // namespace trackbed::fem
