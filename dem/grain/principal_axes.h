// Axes of a body's principal moments of inertia.
#pragma once
#include "dem/types.h"

namespace trackbed::dem {

/// Axes (columns, right-handed) of ascending principal moments. Products of inertia below rounding
/// count as zero, so that a cube, whose axes are arbitrary, keeps the ones it was given. Each of
/// the first two axes has its largest component positive.
Mat3 principal_axes(const Mat3& inertia);

}  // namespace trackbed::dem
