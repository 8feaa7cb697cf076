// MPI and PETSc, started once per process, when the first finite element structure is built.
#pragma once

namespace trackbed::fem {

/// Starts MPI, PETSc and SLEPc (one deal.II thread) unless they run already; they end with the
/// process. A scene without a finite element structure never calls it. Structures call it
/// themselves; a program that wants MPI's ranks early may call it first.
void start_session();

/// Rank of this process and number of processes (0 and 1 before start_session()).
int rank();
int ranks();

}  // namespace trackbed::fem
