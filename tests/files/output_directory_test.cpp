#include "coupling/files/output_directory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

// One for each test and number of ranks: ctest may run them at the same time.
std::string directory() {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return testing::TempDir() + "gasgrain_output_directory/of/a/run_" + std::to_string(ranks);
}

TEST(OutputDirectory, is_made_and_held_by_one_run_at_a_time) {
  std::optional<OutputDirectory> first(std::in_place, MPI_COMM_WORLD, directory());
  EXPECT_TRUE(std::filesystem::is_directory(directory()));
  try {
    OutputDirectory second(MPI_COMM_WORLD, directory());
    ADD_FAILURE() << "a held directory was given to a second run";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find(directory()), std::string::npos) << error.what();
  }
  first.reset();
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_TRUE(std::filesystem::is_empty(directory()));
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_NO_THROW(OutputDirectory(MPI_COMM_WORLD, directory()));
}

TEST(OutputDirectory, that_cannot_be_made_is_an_error_on_every_rank) {
  EXPECT_THROW(OutputDirectory(MPI_COMM_WORLD, "/dev/null/run"), UserError);
}

}  // namespace
}  // namespace gasgrain
