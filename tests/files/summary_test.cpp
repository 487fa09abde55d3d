#include "coupling/files/summary.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

TEST(Summary, is_the_form_that_all_results_have) {
  const Summary summary{"bed", "abc", {{"height", 0.5, "m", 0.4, 0.05, "paper \"1\""}}};
  EXPECT_EQ(summary_text(summary),
            "{\n  \"case\": \"bed\",\n  \"commit\": \"abc\",\n  \"quantities\": [\n"
            "    {\"name\": \"height\", \"value\": 0.5, \"unit\": \"m\", \"reference\": 0.4, "
            "\"tolerance\": 0.05, \"source\": \"paper \\\"1\\\"\"}\n  ]\n}\n");
}

TEST(Summary, writes_null_for_what_is_not_known) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::string text = summary_text({"bed", "abc", {{"height", nan, "m", {}, {}, ""}}});
  EXPECT_NE(text.find("\"value\": null"), std::string::npos);
  EXPECT_NE(text.find("\"reference\": null"), std::string::npos);
}

TEST(Summary, appears_whole_and_leaves_no_part_file) {
  const std::string path = testing::TempDir() + "gasgrain_summary_test.json";
  const Summary summary{"bed", "abc", {}};
  write_summary(path, summary);
  std::ostringstream read;
  read << std::ifstream(path).rdbuf();
  EXPECT_EQ(read.str(), summary_text(summary));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  std::remove(path.c_str());
}

TEST(Summary, names_the_file_it_cannot_write) {
  try {
    write_summary("/nonexistent/summary.json", {});
    FAIL() << "no error";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("/nonexistent/summary.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace gasgrain
