#include "fem/near_null_space.h"

#include <algorithm>

namespace trackbed::fem {

MatNullSpace near_null_space(MPI_Comm ranks, const std::vector<::Vec>& rigid) {
  std::vector<::Vec> kept;
  for (::Vec x : rigid) {
    PetscReal size = 0, rest = 0;
    VecNorm(x, NORM_2, &size);
    for (int pass = 0; pass < 2; ++pass)
      for (::Vec before : kept) {
        PetscScalar share = 0;
        VecDot(x, before, &share);
        VecAXPY(x, -share, before);
      }
    VecNorm(x, NORM_2, &rest);
    if (rest > 1e-8 * size) {
      VecScale(x, 1 / rest);
      kept.push_back(x);
    } else {
      VecDestroy(&x);
    }
  }
  MatNullSpace space = nullptr;
  MatNullSpaceCreate(ranks, PETSC_FALSE, static_cast<PetscInt>(kept.size()), kept.data(), &space);
  for (::Vec& x : kept) VecDestroy(&x);
  return space;
}

MatNullSpace near_null_space(const std::vector<std::vector<double>>& rigid) {
  std::vector<::Vec> motions;
  for (const auto& motion : rigid) {
    ::Vec x = nullptr;
    VecCreateSeq(PETSC_COMM_SELF, static_cast<PetscInt>(motion.size()), &x);
    PetscScalar* to = nullptr;
    VecGetArray(x, &to);
    std::copy(motion.begin(), motion.end(), to);
    VecRestoreArray(x, &to);
    motions.push_back(x);
  }
  return near_null_space(PETSC_COMM_SELF, motions);
}

}  // namespace trackbed::fem
