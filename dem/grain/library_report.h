// What a library of shapes is like: the measured means of its form, and the field's indices.
#pragma once
#include <string>
#include <vector>

#include "dem/grain/shape_indices.h"

namespace trackbed::dem {

struct Spread {
  double mean = 0, deviation = 0, least = 0, largest = 0;
};

struct LibraryReport {
  int shapes = 0;
  Spread elongation, flatness, sphericity, angularity;  ///< [-], see ShapeIndices
  Spread faces;                                         ///< faces of a grain [-]
  Spread solidity;                                      ///< volume over sieve size cubed [-]
  LibraryIndices indices;                               ///< flaky, elongated, slender [%]
};

/// Throws InputError as library_indices.
LibraryReport library_report(const std::vector<GrainShape>&);

/// CSV "index,mean,deviation,least,largest", one line each; the indices [%] have a mean only.
std::string to_csv(const LibraryReport&);

}  // namespace trackbed::dem
