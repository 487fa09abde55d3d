#include "coupling/fatal_error.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

namespace gasgrain::coupling {

namespace {

constexpr int failure_tag = 1;
constexpr auto grace_period = std::chrono::seconds(5);
constexpr auto poll_interval = std::chrono::milliseconds(2);

}  // namespace

FatalErrors::FatalErrors(MPI_Comm communicator) {
  MPI_Comm_dup(communicator, &communicator_);
  MPI_Comm_rank(communicator_, &rank_);
  MPI_Comm_size(communicator_, &ranks_);
}

// Number of ranks known to have failed when all have, or when the grace period is over.
int FatalErrors::announce_and_count_failures() {
  std::vector<MPI_Request> sends(ranks_, MPI_REQUEST_NULL);
  for (int r = 0; r < ranks_; ++r)
    if (r != rank_) MPI_Isend(&rank_, 1, MPI_INT, r, failure_tag, communicator_, &sends[r]);

  int failed = 1;
  lowest_failed_ = rank_;
  const auto deadline = std::chrono::steady_clock::now() + grace_period;
  while (failed < ranks_ && std::chrono::steady_clock::now() < deadline) {
    int arrived = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, failure_tag, communicator_, &arrived, MPI_STATUS_IGNORE);
    if (!arrived) {
      std::this_thread::sleep_for(poll_interval);
      continue;
    }
    int other = 0;
    MPI_Recv(&other, 1, MPI_INT, MPI_ANY_SOURCE, failure_tag, communicator_, MPI_STATUS_IGNORE);
    lowest_failed_ = std::min(lowest_failed_, other);
    ++failed;
  }
  if (failed == ranks_) MPI_Waitall(ranks_, sends.data(), MPI_STATUSES_IGNORE);
  return failed;
}

void FatalErrors::end_program(const std::string& message, std::FILE* log_file) {
  std::fflush(stdout);
  const int failed = announce_and_count_failures();
  if (rank_ == lowest_failed_) {
    std::fprintf(stderr, "ERROR: %s\n", message.c_str());
    if (log_file) std::fprintf(log_file, "ERROR: %s\n", message.c_str());
  }
  std::fflush(nullptr);
  if (failed < ranks_) {
    // The one who prints aborts; the others give it the time to.
    if (rank_ != lowest_failed_) std::this_thread::sleep_for(grace_period);
    MPI_Abort(communicator_, EXIT_FAILURE);
  }
  MPI_Finalize();
  std::_Exit(EXIT_FAILURE);
}

}  // namespace gasgrain::coupling
