// One error for all ranks: what fails on some is thrown on every one, so that none waits for ever.
#pragma once

#include <mpi.h>

#include <string>

#include "coupling/shared/error.hpp"

namespace gasgrain {

// Runs `work` on every rank, then agrees: when it threw a UserError on any of them, every rank
// throws the UserError of the lowest. Collective; `work` itself must not communicate after the
// point where it may fail on some ranks only.
template <class Work>
void run_collectively(MPI_Comm communicator, Work&& work) {
  int rank = 0, size = 1;
  MPI_Comm_rank(communicator, &rank);
  MPI_Comm_size(communicator, &size);
  std::string message;
  int failed = size;
  try {
    work();
  } catch (const UserError& error) {
    message = error.what();
    failed = rank;
  }
  int first = size;
  MPI_Allreduce(&failed, &first, 1, MPI_INT, MPI_MIN, communicator);
  if (first == size) return;
  unsigned long length = message.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, first, communicator);
  message.resize(length);
  MPI_Bcast(message.data(), static_cast<int>(length), MPI_CHAR, first, communicator);
  throw UserError(message);
}

}  // namespace gasgrain
