#include "coupling/files/checkpoint_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

int rank_of_world() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

// A directory of the test's own, shared by all ranks.
class CheckpointFilesTest : public ::testing::Test {
 protected:
  CheckpointFilesTest() {
    int ranks = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    directory_ = "checkpoint_files_" + std::to_string(ranks);
    clear();
  }
  ~CheckpointFilesTest() override { clear(); }

  void clear() const {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank_of_world() == 0) std::filesystem::remove_all(directory_);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  std::string path(const std::string& file) const { return directory_ + "/" + file; }

  std::string directory_;
};

void write_value(Hdf5File& file, double value) {
  const std::uint64_t mine = rank_of_world() == 0 ? 1 : 0;
  file.write("value", {.global = {1}, .start = {0}, .count = {mine}}, &value);
}

std::string write(CheckpointFiles& files, long step) {
  return files.write(step, [&](Hdf5File& file) { write_value(file, double(step)); });
}

TEST_F(CheckpointFilesTest, the_last_two_stay_and_the_newest_is_first) {
  CheckpointFiles files(MPI_COMM_WORLD, directory_, "run");
  EXPECT_TRUE(files.found().empty());
  for (const long step : {9, 10, 100000}) write(files, step);
  const std::vector<std::string> expected{path("run_000000100000.h5"), path("run_000000000010.h5")};
  EXPECT_EQ(files.found(), expected);
  EXPECT_EQ(Hdf5File::open(expected[0]).read<double>("value"), std::vector<double>{100000});
}

TEST_F(CheckpointFilesTest, a_failing_write_leaves_the_last_complete_one) {
  CheckpointFiles files(MPI_COMM_WORLD, directory_, "run");
  const std::string good = write(files, 1);
  const auto fail = [](Hdf5File& file) {
    write_value(file, 2.0);
    throw UserError("disk full");
  };
  EXPECT_THROW(files.write(2, fail), UserError);
  EXPECT_EQ(files.found(), std::vector<std::string>{good});
}

TEST_F(CheckpointFilesTest,
       what_is_not_a_whole_checkpoint_of_that_name_is_neither_found_nor_removed) {
  CheckpointFiles files(MPI_COMM_WORLD, directory_, "run");
  const std::vector<std::string> others{path("run_000000000003.h5.part"), path("run_3.h5"),
                                        path("running_000000000003.h5"),
                                        path("other_000000000003.h5"), path("run_00000000000x.h5")};
  if (rank_of_world() == 0) {
    for (const std::string& other : others) std::ofstream(other) << "x";
  }
  const std::string only = write(files, 4);
  EXPECT_EQ(files.found(), std::vector<std::string>{only});
  for (const std::string& other : others) EXPECT_TRUE(std::filesystem::exists(other)) << other;
}

TEST_F(CheckpointFilesTest, of_an_earlier_run_stay_until_the_first_of_this_one_is_complete) {
  {
    CheckpointFiles earlier(MPI_COMM_WORLD, directory_, "run");
    write(earlier, 50);
    write(earlier, 60);
  }
  CheckpointFiles files(MPI_COMM_WORLD, directory_, "run");
  EXPECT_EQ(files.found().size(), 2u);
  const std::string only = write(files, 5);
  EXPECT_EQ(files.found(), std::vector<std::string>{only});
}

TEST_F(CheckpointFilesTest, the_one_continued_from_is_kept_and_those_of_its_lost_future_go) {
  {
    CheckpointFiles earlier(MPI_COMM_WORLD, directory_, "run");
    write(earlier, 50);
    write(earlier, 60);
  }
  CheckpointFiles files(MPI_COMM_WORLD, directory_, "run");
  files.continue_from("./" + path("run_000000000050.h5"));
  const std::string next = write(files, 55);
  const std::vector<std::string> expected{next, path("run_000000000050.h5")};
  EXPECT_EQ(files.found(), expected);
}

TEST_F(CheckpointFilesTest, a_directory_that_cannot_be_is_an_error_on_every_rank) {
  if (rank_of_world() == 0) std::ofstream(directory_) << "a file";
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_THROW(CheckpointFiles(MPI_COMM_WORLD, directory_, "run"), UserError);
}

}  // namespace
}  // namespace gasgrain
