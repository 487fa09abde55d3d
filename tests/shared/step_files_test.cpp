#include "coupling/shared/step_files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace gasgrain {
namespace {

const StepFileName padded{"gas_", ".h5", 4}, plain{"grains.", ".restart"};

TEST(StepFiles, names_and_steps_belong_together) {
  EXPECT_EQ(file_of_step(padded, 12), "gas_0012.h5");
  EXPECT_EQ(file_of_step(padded, 123456), "gas_123456.h5");
  EXPECT_EQ(file_of_step(plain, 0), "grains.0.restart");
  for (const long step : {0L, 7L, 9999L, 10000L}) {
    EXPECT_EQ(step_of_file(padded, file_of_step(padded, step)), step);
    EXPECT_EQ(step_of_file(plain, file_of_step(plain, step)), step);
  }
}

TEST(StepFiles, other_names_have_no_step) {
  for (const char* other :
       {"gas_12.h5", "gas_00012.h5", "gas_.h5", "gas_0012.h5.part", "gas_001x.h5", "as_0012.h5",
        "gas_-012.h5", "", "gas_99999999999999999999.h5"})
    EXPECT_FALSE(step_of_file(padded, other)) << other;
  for (const char* other : {"grains.restart", "grains.1.restart.partial", "grains.01.restart"})
    EXPECT_FALSE(step_of_file(plain, other)) << other;
}

TEST(StepFiles, the_newest_comes_first_and_two_are_kept) {
  const std::string directory = "step_files_test";
  std::filesystem::remove_all(directory);
  EXPECT_TRUE(files_of_steps(directory, plain).empty());
  std::filesystem::create_directory(directory);
  for (const char* name : {"grains.9.restart", "grains.10.restart", "grains.200.restart",
                           "grains.50.restart", "gas.9.state.h5", "latest.restart"})
    std::ofstream(directory + "/" + name) << "x";
  std::vector<long> steps;
  for (const StepFile& file : files_of_steps(directory, plain)) steps.push_back(file.step);
  EXPECT_EQ(steps, (std::vector<long>{200, 50, 10, 9}));

  keep_last_two(directory, plain, 50, 10);
  steps.clear();
  for (const StepFile& file : files_of_steps(directory, plain)) steps.push_back(file.step);
  EXPECT_EQ(steps, (std::vector<long>{50, 10}));
  EXPECT_TRUE(std::filesystem::exists(directory + "/gas.9.state.h5"));
  EXPECT_TRUE(std::filesystem::exists(directory + "/latest.restart"));

  keep_last_two(directory, plain, 50, std::nullopt);
  EXPECT_EQ(files_of_steps(directory, plain).size(), 1u);
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace gasgrain
