// What multigrid for elasticity must be told: the rigid motions, for what coarse levels cannot
// represent converges slowly. Internal: PETSc.
#pragma once
#include <petscksp.h>

#include <vector>

namespace trackbed::fem {

/// The motions made orthonormal, as PETSc wants them; those of which supports leave nothing are
/// dropped. Takes the vectors over; goes with MatNullSpaceDestroy.
MatNullSpace near_null_space(MPI_Comm, const std::vector<::Vec>& rigid);

/// The same on one process, from values of the unknowns.
MatNullSpace near_null_space(const std::vector<std::vector<double>>& rigid);

}  // namespace trackbed::fem
