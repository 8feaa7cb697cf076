#include "fem/session.h"

#include <deal.II/base/mpi.h>

namespace trackbed::fem {
namespace {

bool mpi_runs() {
  int started = 0, ended = 0;
  MPI_Initialized(&started);
  MPI_Finalized(&ended);
  return started && !ended;
}

}  // namespace

void start_session() {
  if (mpi_runs()) return;
  // PETSc would catch the signals that the program answers with a checkpoint.
  static char program[] = "trackbed", option[] = "-no_signal_handler";
  static char* arguments[] = {program, option, nullptr};
  static int count = 2;
  static char** values = arguments;
  static dealii::Utilities::MPI::MPI_InitFinalize session(count, values, 1);
}

int rank() {
  int r = 0;
  if (mpi_runs()) MPI_Comm_rank(MPI_COMM_WORLD, &r);
  return r;
}

int ranks() {
  int n = 1;
  if (mpi_runs()) MPI_Comm_size(MPI_COMM_WORLD, &n);
  return n;
}

}  // namespace trackbed::fem
