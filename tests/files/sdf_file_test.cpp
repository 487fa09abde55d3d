#include "coupling/files/sdf_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "coupling/files/hdf5_file.hpp"
#include "coupling/files/mapped_file.hpp"
#include "coupling/shared/boolean_shapes.hpp"
#include "coupling/shared/primitives.hpp"
#include "coupling/shared/sampling.hpp"
#include "tests/shared/error_checks.hpp"

namespace gasgrain {
namespace {

class SdfFile : public testing::Test {
 protected:
  SdfFile()
      : directory_(std::filesystem::temp_directory_path() /
                   ("gasgrain_sdf_" +
                    std::string(testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    std::filesystem::create_directories(directory_);
  }
  ~SdfFile() override { std::filesystem::remove_all(directory_); }

  std::string path(const std::string& name) const { return (directory_ / name).string(); }

  static SampledDistance ball(Interpolation interpolation = Interpolation::linear,
                              SampleStorage storage = SampleStorage::plain) {
    const Shape shape = make_difference(make_shape(Sphere{Vec3(0.1, 0.2, 0.3), 1.0 / 3}),
                                        make_shape(Sphere{Vec3(0.2, 0.3, 0.4), 0.1}));
    return sample_shape(*shape, {.lower = Vec3(-0.7, -0.6, -0.5),
                                 .upper = Vec3(0.9, 1.3, 1.0),
                                 .spacing = 0.03,
                                 .band = 0.1,
                                 .cut = false,
                                 .interpolation = interpolation,
                                 .storage = storage});
  }

 private:
  std::filesystem::path directory_;
};

template <class Values>
void expect_same_bits(const Values& a, const Values& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(*a.data())), 0);
}

void expect_same(const SampledDistance& written, const SampledDistance& read) {
  const BrickSamples &a = written.data(), &b = read.data();
  EXPECT_NE(a.bricks[0], a.bricks[1]);  // so that a mixed-up order shows
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.band, b.band);
  EXPECT_EQ(a.cut, b.cut);
  EXPECT_EQ(a.interpolation, b.interpolation);
  EXPECT_EQ(a.quantum, b.quantum);
  EXPECT_EQ(a.bricks, b.bricks);
  expect_same_bits(a.table, b.table);
  expect_same_bits(a.block_value, b.block_value);
  expect_same_bits(a.brick, b.brick);
  expect_same_bits(a.samples, b.samples);
  expect_same_bits(a.compact_samples, b.compact_samples);
  for (const double x : {-3.0, -0.2, 0.0, 0.11, 0.4, 0.8, 5.0}) {
    EXPECT_EQ(written.sample(Vec3(x, 0.2, 0.3)).gradient, read.sample(Vec3(x, 0.2, 0.3)).gradient);
  }
}

TEST_F(SdfFile, ReadsBackBitForBit) {
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::quadratic}) {
    for (const SampleStorage storage : {SampleStorage::plain, SampleStorage::compact}) {
      const SampledDistance written = ball(interpolation, storage);
      write_sdf(path("ball.h5"), written);
      expect_same(written, read_sdf(path("ball.h5")));
    }
  }
}

// Samples are not read but mapped, so that the processes of a machine share them.
TEST_F(SdfFile, IsMappedAndMayBeRemovedWhileInUse) {
  const SampledDistance written = ball();
  write_sdf(path("ball.h5"), written);
  const Hdf5File file = Hdf5File::open(path("ball.h5"));
  EXPECT_TRUE(file.place_in_file<float>("/samples").has_value());
  EXPECT_FALSE(file.place_in_file<double>("/samples").has_value());
  const SampledDistance read = read_sdf(path("ball.h5"));
  std::filesystem::remove(path("ball.h5"));
  expect_same(written, read);
}

TEST_F(SdfFile, IsNotMappedBeyondItsEnd) {
  std::ofstream(path("short"), std::ios::binary) << "sixteen bytes ..";
  EXPECT_EQ(mapped_array<float>(path("short"), 4, 3).size(), 3u);
  expect_contains(user_error([&] { mapped_array<float>(path("short"), 4, 4); }), "too short");
  expect_contains(user_error([&] { mapped_array<float>(path("missing"), 0, 1); }), "missing");
}

// Any byte changed: read, or refused with a UserError.
TEST_F(SdfFile, SurvivesDamage) {
  write_sdf(path("ball.h5"), ball());
  std::ifstream whole(path("ball.h5"), std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(whole)), {});
  std::mt19937 random{11};
  int refused = 0;
  for (int n = 0; n < 300; ++n) {
    std::string damaged = bytes;
    for (int k = 0; k < 4; ++k) damaged[random() % 8000] = static_cast<char>(random());
    std::ofstream(path("damaged.h5"), std::ios::binary) << damaged;
    try {
      read_sdf(path("damaged.h5"));
    } catch (const UserError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(SdfFile, LeavesNoUnfinishedFile) {
  write_sdf(path("ball.h5"), ball());
  EXPECT_TRUE(std::filesystem::exists(path("ball.h5")));
  EXPECT_FALSE(std::filesystem::exists(path("ball.h5.part")));
}

TEST_F(SdfFile, LoadsAsAShapeThatIsChecked) {
  write_sdf(path("ball.h5"), ball());
  EXPECT_NEAR(load_sdf_shape(path("ball.h5"))->distance(Vec3(0.1, 0.2 - 0.4, 0.3)), 0.4 - 1.0 / 3,
              2e-3);

  BrickSamples open = ball().data();
  std::vector<float> samples = open.samples.copy();
  const auto inside = std::min_element(samples.begin(), samples.end());
  *inside = -*inside;
  open.samples = samples;
  write_sdf(path("open.h5"), SampledDistance(open));
  expect_contains(user_error([&] { load_sdf_shape(path("open.h5")); }), "body not closed");
  expect_contains(user_error([&] { load_sdf_shape(path("open.h5")); }), "open.h5");
}

TEST_F(SdfFile, RefusesOtherFiles) {
  expect_contains(user_error([&] { read_sdf(path("missing.h5")); }), "missing.h5");
  std::ofstream(path("text.h5")) << "not HDF5";
  expect_contains(user_error([&] { read_sdf(path("text.h5")); }), "text.h5");
  Hdf5File::create(path("other.h5")).close();
  expect_contains(user_error([&] { read_sdf(path("other.h5")); }), "no SDF file of gasgrain");
  Hdf5File newer = Hdf5File::create(path("newer.h5"));
  newer.write_attribute("format", std::string("gasgrain signed distance"));
  newer.write_attribute<std::int64_t>("version", {4});
  newer.close();
  expect_contains(user_error([&] { read_sdf(path("newer.h5")); }), "has version 4");
}

TEST_F(SdfFile, RefusesATruncatedFile) {
  write_sdf(path("ball.h5"), ball());
  std::filesystem::resize_file(path("ball.h5"), std::filesystem::file_size(path("ball.h5")) / 2);
  expect_contains(user_error([&] { read_sdf(path("ball.h5")); }), "ball.h5");
}

TEST_F(SdfFile, CannotBeWrittenToAMissingDirectory) {
  expect_contains(user_error([&] { write_sdf(path("no/ball.h5"), ball()); }), "no/ball.h5");
}

}  // namespace
}  // namespace gasgrain
