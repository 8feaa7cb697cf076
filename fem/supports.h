// Which node moves in which direction, and what a static answer needs.
#pragma once
#include <map>
#include <string>

#include "fem/discretisation.h"
#include "fem/elastic_body.h"

namespace trackbed::fem {

/// Boundary id by name. \throws InputError naming `what` and the boundaries there are.
int find_boundary(const Discretisation&, const std::string& body, const std::string& what,
                  const std::string& boundary);

/// Numbers the unknowns. \throws InputError: unknown boundary, a roller not normal to an axis, a
/// periodic pair whose sides do not match.
Unknowns number_unknowns(const Discretisation&, const std::string& body,
                         const std::map<std::string, Support>&);

/// "" if supports and beds hold the body against all six rigid motions; else what is free.
std::string free_motion(const Discretisation&, const Unknowns&, const std::vector<Bed>&);

/// Three shifts and three turns about the origin, as values of the unknowns.
std::vector<std::vector<double>> rigid_motions(const Discretisation&, const Unknowns&);

}  // namespace trackbed::fem
