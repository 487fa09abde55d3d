#include <gtest/gtest.h>

#include "coupling/files/collective_error.hpp"

namespace gasgrain {
namespace {

TEST(CollectiveError, nothing_happens_when_all_succeed) {
  EXPECT_NO_THROW(run_collectively(MPI_COMM_WORLD, [] {}));
}

TEST(CollectiveError, every_rank_gets_the_message_of_the_lowest_failing_one) {
  int rank = 0, size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const int first = size > 2 ? 1 : size - 1;
  std::string message;
  try {
    run_collectively(MPI_COMM_WORLD, [&] {
      if (rank >= first) throw UserError("from rank " + std::to_string(rank));
    });
  } catch (const UserError& error) {
    message = error.what();
  }
  EXPECT_EQ(message, "from rank " + std::to_string(first));
}

}  // namespace
}  // namespace gasgrain
