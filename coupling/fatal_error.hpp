// Ends a parallel program after an exception: the message appears once, every rank exits non-zero.
#pragma once

#include <mpi.h>

#include <cstdio>
#include <string>

namespace gasgrain::coupling {

// An error may be met by all ranks (bad input, read by each) or by some, while the others wait for
// them in a collective call. Ranks that fail tell each other on a communicator of their own:
//   all failed   rank 0 prints, everybody finalizes MPI and exits with 1
//   some failed  after a grace period the lowest of them prints and aborts the others
class FatalErrors {
 public:
  // Collective; duplicates the communicator, so that failing ranks are not confused with traffic.
  explicit FatalErrors(MPI_Comm communicator);

  // Prints `message` as above, on stderr and in `log_file` when that is not null. Does not return.
  [[noreturn]] void end_program(const std::string& message, std::FILE* log_file);

 private:
  int announce_and_count_failures();

  MPI_Comm communicator_ = MPI_COMM_NULL;
  int rank_ = 0;
  int ranks_ = 1;
  int lowest_failed_ = 0;
};

}  // namespace gasgrain::coupling
