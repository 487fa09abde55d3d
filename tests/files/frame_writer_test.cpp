#include "coupling/files/frame_writer.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "coupling/files/hdf5_file.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain {
namespace {

constexpr std::array<int, 3> cells{5, 4, 7};

class Frames : public testing::Test {
 protected:
  Frames() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    directory = "frame_writer_test." + std::to_string(ranks);
    remove_directory();
  }
  ~Frames() override { remove_directory(); }

  void remove_directory() const {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0) std::filesystem::remove_all(directory);
    MPI_Barrier(MPI_COMM_WORLD);
  }

  std::string index(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(directory + "/" + name + ".xdmf").rdbuf();
    return text.str();
  }

  // A grid frame whose value says where it belongs: 100 k + 10 j + i, plus `extra`.
  void write_grid(FrameWriter& writer, double time, double extra = 0) const {
    GridFrame frame{.cells = cells,
                    .lower = Vec3(-1, -2, -3),
                    .spacing = Vec3(0.1, 0.2, 0.3),
                    .block_lower = {0, 0, cells[2] * rank / ranks},
                    .block_cells = {cells[0], cells[1], 0},
                    .arrays = {}};
    frame.block_cells[2] = cells[2] * (rank + 1) / ranks - frame.block_lower[2];
    std::vector<double> place, velocity;
    for (int k = 0; k < frame.block_cells[2]; ++k) {
      for (int j = 0; j < cells[1]; ++j) {
        for (int i = 0; i < cells[0]; ++i) {
          place.push_back(100 * (k + frame.block_lower[2]) + 10 * j + i + extra);
          velocity.insert(velocity.end(), {1.0 * i, 1.0 * j, 1.0 * (k + frame.block_lower[2])});
        }
      }
    }
    frame.arrays = {{"place", 1, place.data()}, {"velocity", 3, velocity.data()}};
    writer.write(time, frame);
  }

  // Rank r holds r grains, so rank 0 none.
  void write_grains(FrameWriter& writer, double time) const {
    std::vector<double> positions, radius;
    std::vector<std::int64_t> ids;
    for (int n = 0; n < rank; ++n) {
      const int id = 100 * rank + n;
      ids.push_back(id);
      positions.insert(positions.end(), {1.0 * id, 2.0 * id, 3.0 * id});
      radius.push_back(0.5 * id);
    }
    writer.write(time, PointFrame{.count = ids.size(),
                                  .positions = positions.data(),
                                  .ids = ids.data(),
                                  .arrays = {{"radius", 1, radius.data()}}});
  }

  int rank = 0, ranks = 1;
  std::string directory;
};

TEST_F(Frames, GridsReadBackEqual) {
  FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
  write_grid(writer, 0.125);
  const Hdf5File in = Hdf5File::open(directory + "/gas_000000.h5");
  EXPECT_EQ(in.size("place"), (std::vector<std::uint64_t>{7, 4, 5}));
  EXPECT_EQ(in.size("velocity"), (std::vector<std::uint64_t>{7, 4, 5, 3}));
  const auto place = in.read<double>("place"), velocity = in.read<double>("velocity");
  std::size_t n = 0;
  for (int k = 0; k < 7; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 5; ++i, ++n) {
        EXPECT_EQ(place[n], 100 * k + 10 * j + i);
        EXPECT_EQ(velocity[3 * n], i);
        EXPECT_EQ(velocity[3 * n + 1], j);
        EXPECT_EQ(velocity[3 * n + 2], k);
      }
    }
  }
}

TEST_F(Frames, GrainsReadBackEqual) {
  FrameWriter writer(MPI_COMM_WORLD, directory, "grains");
  write_grains(writer, 0.125);
  const Hdf5File in = Hdf5File::open(directory + "/grains_000000.h5");
  const auto ids = in.read<std::int64_t>("id"), vertices = in.read<std::int64_t>("vertex");
  const auto positions = in.read<double>("position"), radius = in.read<double>("radius");
  ASSERT_EQ(ids.size(), static_cast<std::size_t>(ranks * (ranks - 1) / 2));
  std::map<std::int64_t, int> seen;
  for (std::size_t n = 0; n < ids.size(); ++n) {
    ++seen[ids[n]];
    EXPECT_EQ(vertices[n], static_cast<std::int64_t>(n));
    EXPECT_EQ(radius[n], 0.5 * ids[n]);
    for (int d = 0; d < 3; ++d) EXPECT_EQ(positions[3 * n + d], (d + 1.0) * ids[n]);
  }
  EXPECT_EQ(seen.size(), ids.size());
}

TEST_F(Frames, TheIndexListsCompleteFramesOnly) {
  FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
  write_grid(writer, 0.0);
  write_grid(writer, 0.1);
  EXPECT_EQ(writer.times(), (std::vector<double>{0.0, 0.1}));
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  }
  // a job killed while it wrote the third frame
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) std::ofstream(directory + "/gas_000002.h5.part") << "half";
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(index("gas").find("gas_000002"), std::string::npos);
  FrameWriter later(MPI_COMM_WORLD, directory, "gas", Series::resume);
  EXPECT_EQ(later.times(), (std::vector<double>{0.0, 0.1}));
}

TEST_F(Frames, AResumedSeriesReplacesLaterFrames) {
  {
    FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
    for (const double time : {0.0, 0.1, 0.2, 1.0 / 3}) write_grid(writer, time);
  }
  FrameWriter writer(MPI_COMM_WORLD, directory, "gas", Series::resume);
  EXPECT_EQ(writer.times(), (std::vector<double>{0.0, 0.1, 0.2, 1.0 / 3}));
  write_grid(writer, 0.2, 0.5);
  EXPECT_EQ(writer.times(), (std::vector<double>{0.0, 0.1, 0.2}));
  EXPECT_EQ(Hdf5File::open(directory + "/gas_000002.h5").read<double>("place")[0], 0.5);
  EXPECT_EQ(Hdf5File::open(directory + "/gas_000002.h5").attribute<double>("time")[0], 0.2);
  EXPECT_FALSE(std::filesystem::exists(directory + "/gas_000003.h5"));
  EXPECT_EQ(index("gas").find("gas_000003"), std::string::npos);
}

TEST_F(Frames, AResumedIndexEqualsThatOfOneRun) {
  {
    FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
    for (const double time : {0.0, 0.1, 0.2}) write_grid(writer, time);
  }
  const std::string whole = index("gas");
  MPI_Barrier(MPI_COMM_WORLD);
  {
    FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
    write_grid(writer, 0.0);
    write_grid(writer, 0.1);
  }
  FrameWriter writer(MPI_COMM_WORLD, directory, "gas", Series::resume);
  write_grid(writer, 0.2);
  EXPECT_EQ(index("gas"), whole);
}

TEST_F(Frames, ANewSeriesForgetsTheOldOne) {
  {
    FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
    write_grid(writer, 0.0);
    write_grid(writer, 0.1);
  }
  const FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
  EXPECT_TRUE(writer.times().empty());
  EXPECT_FALSE(std::filesystem::exists(directory + "/gas_000001.h5"));
}

TEST_F(Frames, TheIndexReferencesTheDataInParaViewsOrder) {
  FrameWriter writer(MPI_COMM_WORLD, directory, "gas");
  write_grid(writer, 0.125);
  const std::string text = index("gas");
  expect_contains(text, "TopologyType=\"3DCoRectMesh\" Dimensions=\"8 5 6\"");  // nodes, z y x
  expect_contains(text, ">-3 -2 -1<");
  expect_contains(text, ">0.3 0.2 0.1<");
  expect_contains(text, "<Time Value=\"0.125\"/>");
  expect_contains(text, "Dimensions=\"7 4 5\"");
  expect_contains(text, "Dimensions=\"7 4 5 3\"");
  expect_contains(text, "gas_000000.h5:/velocity");
}

TEST_F(Frames, ADirectoryThatCannotBeMadeIsAUserErrorOnEveryRank) {
  if (rank == 0) std::ofstream("frame_writer_test.file") << "x";
  MPI_Barrier(MPI_COMM_WORLD);
  expect_contains(
      user_error([] { FrameWriter(MPI_COMM_WORLD, "frame_writer_test.file/out", "gas"); }),
      "frame_writer_test.file/out");
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) std::filesystem::remove("frame_writer_test.file");
}

// Leaves two series behind for read_frames.py when that asks for them.
TEST_F(Frames, WritesASampleForOtherReaders) {
  const char* wanted = std::getenv("GASGRAIN_SAMPLE_FRAMES");
  if (!wanted) GTEST_SKIP() << "only for read_frames.py";
  FrameWriter gas(MPI_COMM_WORLD, wanted, "gas"), grains(MPI_COMM_WORLD, wanted, "grains");
  for (const double time : {0.0, 0.1, 0.25}) {
    write_grid(gas, time, 1000 * time);
    write_grains(grains, time);
  }
}

}  // namespace
}  // namespace gasgrain
