#include "coupling/files/csv_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "coupling/shared/error.hpp"

namespace gasgrain {
namespace {

class Csv : public testing::Test {
 protected:
  ~Csv() override { std::filesystem::remove(path); }

  // One for each test: ctest runs them at the same time.
  const std::string path =
      std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".csv";

  std::string content() const {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  // Rows at those times, the second column being its square.
  void write(std::initializer_list<double> times, std::optional<double> from = {}) const {
    CsvFile file(path, {"time_s", "value"}, from);
    for (const double t : times) file.add(std::array{t, t * t});
  }
};

TEST_F(Csv, numbers_read_back_with_the_same_bits) {
  const std::vector<double> row{
      0.1 + 0.2, -1e-300, 1.0 / 3.0, 1e22, std::numeric_limits<double>::infinity(), -std::nan("")};
  {
    CsvFile file(path, {"a", "b", "c", "d", "e", "f"}, {});
    file.add(row);
  }
  std::istringstream line(content().substr(content().find('\n') + 1));
  std::string cell;
  for (const double value : row) {
    std::getline(line, cell, ',');
    if (std::isnan(value)) {
      EXPECT_EQ(cell, "nan\n");
    } else {
      EXPECT_EQ(std::stod(cell), value);
    }
  }
}

TEST_F(Csv, a_continued_file_is_that_of_an_uninterrupted_run) {
  write({0.1, 0.2, 0.3, 0.4, 0.5});
  const std::string whole = content();
  write({0.1, 0.2, 0.3, 0.35});
  write({0.3, 0.4, 0.5}, 0.2);  // from a checkpoint at 0.2
  EXPECT_EQ(content(), whole);
}

TEST_F(Csv, half_a_row_that_a_kill_left_is_dropped) {
  write({0.1, 0.2});
  const std::string whole = content();
  std::ofstream(path, std::ios::app) << "0.1";  // looks like an early time
  write({}, 0.2);
  EXPECT_EQ(content(), whole);
}

TEST_F(Csv, there_is_nothing_to_continue_in_an_absent_or_empty_file) {
  write({0.3}, 0.2);
  EXPECT_EQ(content(), "time_s,value\n0.3,0.09\n");
  std::ofstream(path, std::ios::trunc).flush();
  write({0.3}, 0.2);
  EXPECT_EQ(content(), "time_s,value\n0.3,0.09\n");
}

TEST_F(Csv, a_run_that_starts_anew_starts_the_file_anew) {
  write({0.1, 0.2});
  write({0.1});
  EXPECT_EQ(content(), "time_s,value\n0.1,0.010000000000000002\n");
}

TEST_F(Csv, a_file_with_other_columns_is_not_touched) {
  std::ofstream(path) << "time_s,other\n0.1,1\n";
  EXPECT_THROW(write({}, 0.2), UserError);
  EXPECT_EQ(content(), "time_s,other\n0.1,1\n");
}

TEST_F(Csv, a_place_that_cannot_be_written_is_an_error) {
  EXPECT_THROW(CsvFile("absent_directory/x.csv", {"time_s"}, {}), UserError);
}

}  // namespace
}  // namespace gasgrain
