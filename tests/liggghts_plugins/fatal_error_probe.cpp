// Fails on the ranks named on the command line while the others wait for them; see
// fatal_error_test.py.
#include <mpi.h>

#include <cstdlib>
#include <string>

#include "coupling/fatal_error.hpp"

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  gasgrain::coupling::FatalErrors errors(MPI_COMM_WORLD);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (int i = 1; i < argc; ++i)
    if (std::atoi(argv[i]) == rank)
      errors.end_program("rank " + std::to_string(rank) + " failed", nullptr);
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Finalize();
}
