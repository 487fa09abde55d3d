#include "coupling/files/hdf5_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "coupling/shared/error.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain {
namespace {

class Hdf5 : public testing::Test {
 protected:
  Hdf5() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    path = "hdf5_file_test." + std::to_string(ranks) + ".h5";
  }
  ~Hdf5() override {
    MPI_Barrier(MPI_COMM_WORLD);
    if (rank == 0) std::filesystem::remove(path);
    MPI_Barrier(MPI_COMM_WORLD);
  }

  // Rank r holds the rows [r (r+1)/2, (r+1)(r+2)/2): 1, 2, 3 ... of them.
  ArrayBlock rows(std::uint64_t columns) const {
    const auto r = static_cast<std::uint64_t>(rank), n = static_cast<std::uint64_t>(ranks);
    return {.global = {n * (n + 1) / 2, columns},
            .start = {r * (r + 1) / 2, 0},
            .count = {r + 1, columns}};
  }

  int rank = 0, ranks = 1;
  std::string path;
};

TEST_F(Hdf5, BlocksOfAllRanksMakeTheDataset) {
  const ArrayBlock block = rows(3);
  std::vector<double> values;
  for (std::uint64_t n = 0; n < 3 * block.count[0]; ++n) {
    values.push_back(0.1 + static_cast<double>(3 * block.start[0] + n));
  }
  Hdf5File out = Hdf5File::create(path, MPI_COMM_WORLD);
  out.write_attribute<double>("time", {0.1, 0.2});
  out.write_attribute("format", std::string("rows"));
  out.write("group/inner/rows", block, values.data());
  out.close();

  const Hdf5File alone = Hdf5File::open(path);
  EXPECT_EQ(alone.size("group/inner/rows"), block.global);
  EXPECT_EQ(alone.attribute<double>("time"), (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(alone.text_attribute("format"), "rows");
  EXPECT_TRUE(alone.has_attribute("time") && !alone.has_attribute("tim"));
  const std::vector<double> all = alone.read<double>("group/inner/rows");
  ASSERT_EQ(all.size(), block.global[0] * 3);
  for (std::size_t n = 0; n < all.size(); ++n) EXPECT_EQ(all[n], 0.1 + static_cast<double>(n));

  const Hdf5File together = Hdf5File::open(path, MPI_COMM_WORLD);
  std::vector<double> mine(values.size());
  together.read("group/inner/rows", block, mine.data());
  EXPECT_EQ(mine, values);
}

TEST_F(Hdf5, TextsMayBeLongerThanAnAttribute) {
  const std::string text = "first line\n" + std::string(100000, 'x') + "\n";
  Hdf5File out = Hdf5File::create(path, MPI_COMM_WORLD);
  out.write_text("case", text);
  out.write_text("empty", "");
  out.flush();
  out.close();
  EXPECT_EQ(Hdf5File::open(path).read_text("case"), text);
  EXPECT_EQ(Hdf5File::open(path, MPI_COMM_WORLD).read_text("empty"), "");
  EXPECT_THROW((void)Hdf5File::open(path).read_text("absent"), UserError);
}

TEST_F(Hdf5, RanksAndDatasetsMayBeEmpty) {
  // only rank 0 holds something in the first dataset, nobody in the second
  const std::vector<std::int64_t> values{1, 2};
  const std::uint64_t here = rank == 0 ? 2 : 0;
  Hdf5File out = Hdf5File::create(path, MPI_COMM_WORLD);
  out.write<std::int64_t>("some", {{2}, {rank == 0 ? 0U : 2U}, {here}},
                          rank == 0 ? values.data() : nullptr);
  out.write<std::int64_t>("none", {{0}, {0}, {0}}, nullptr);
  out.close();
  const Hdf5File in = Hdf5File::open(path);
  EXPECT_EQ(in.read<std::int64_t>("some"), values);
  EXPECT_TRUE(in.read<std::int64_t>("none").empty());
}

TEST_F(Hdf5, ErrorsNameTheFileOnEveryRank) {
  expect_contains(user_error([] { Hdf5File::open("nowhere.h5", MPI_COMM_WORLD); }), "nowhere.h5");
  expect_contains(user_error([] { Hdf5File::create("no/where.h5", MPI_COMM_WORLD); }),
                  "no/where.h5");
  Hdf5File::create(path, MPI_COMM_WORLD).close();
  const Hdf5File in = Hdf5File::open(path);
  expect_contains(user_error([&] { in.read<double>("absent"); }), "absent");
  expect_contains(user_error([&] { in.attribute<double>("absent"); }), path);
}

TEST_F(Hdf5, RefusesABlockBeyondItsDataset) {
  Hdf5File out = Hdf5File::create(path, MPI_COMM_WORLD);
  const double value = 1;
  EXPECT_THROW(out.write("x", {{1}, {1}, {1}}, &value), InternalError);
}

}  // namespace
}  // namespace gasgrain
