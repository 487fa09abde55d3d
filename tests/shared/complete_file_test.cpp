#include "coupling/shared/complete_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

void write(const std::string& path, const std::string& words) {
  std::ofstream(path) << words;
}

std::string content(const std::string& path) {
  std::string words;
  std::getline(std::ifstream(path), words);
  return words;
}

TEST(CompleteFile, replaces_the_one_of_that_name) {
  for (const std::string path : {"complete_file_test", "./complete_file_test"}) {
    write(path, "old");
    write(path + ".part", "new");
    complete_file(path + ".part", path);
    EXPECT_EQ(content(path), "new");
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
    std::filesystem::remove(path);
  }
}

TEST(CompleteFile, leaves_the_one_of_that_name_when_it_fails) {
  write("complete_file_kept", "old");
  EXPECT_THROW(complete_file("complete_file_absent", "complete_file_kept"), UserError);
  EXPECT_EQ(content("complete_file_kept"), "old");
  write("complete_file_part", "new");
  EXPECT_THROW(complete_file("complete_file_part", "no_such_directory/name"), UserError);
  std::filesystem::remove("complete_file_kept");
  std::filesystem::remove("complete_file_part");
}

}  // namespace
}  // namespace gasgrain
