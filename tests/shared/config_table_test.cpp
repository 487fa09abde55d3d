#include "coupling/shared/config_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/shared/error_checks.hpp"

namespace gasgrain {
namespace {

ConfigTable parse(const std::string& text) {
  return ConfigTable::parse(text, "bed.toml");
}

const std::string gas_text =
    "[gas]\n"
    "density = 1.2\n"
    "viscosity = 2\n"
    "steps = 7\n"
    "name = \"air\"\n"
    "on = true\n"
    "velocity = [1, 2.5, 3]\n"
    "cells = [4, 5, 6]\n"
    "words = [\"a\", \"b\"]\n"
    "mixed = [1, \"b\"]\n";

class GasTable : public testing::Test {
 protected:
  ConfigTable gas = parse(gas_text).table("gas");
};

TEST_F(GasTable, ReadsEveryType) {
  EXPECT_EQ(gas.number("density"), 1.2);
  EXPECT_EQ(gas.number("viscosity"), 2.0);  // an integer is a number
  EXPECT_EQ(gas.integer("steps"), 7);
  EXPECT_EQ(gas.text("name"), "air");
  EXPECT_TRUE(gas.flag_or("on", false));
  EXPECT_EQ(gas.vector("velocity"), Vec3(1, 2.5, 3));
  EXPECT_EQ(gas.integers3("cells"), (std::array<int, 3>{4, 5, 6}));
  EXPECT_EQ(gas.texts("words"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(gas.choice("name", {"water", "air"}), "air");
}

TEST_F(GasTable, GivesDefaultsOnlyForAbsentKeys) {
  EXPECT_EQ(gas.number_or("density", 9), 1.2);
  EXPECT_EQ(gas.number_or("absent", 9), 9);
  EXPECT_EQ(gas.integer_or("absent", 3), 3);
  EXPECT_EQ(gas.text_or("absent", "x"), "x");
  EXPECT_FALSE(gas.flag_or("absent", false));
  EXPECT_EQ(gas.vector_or("absent", Vec3(1, 1, 1)), Vec3(1, 1, 1));
  EXPECT_EQ(gas.choice_or("absent", "b", {"a", "b"}), "b");
  EXPECT_FALSE(parse(gas_text).table_or_empty("absent").has("x"));
  EXPECT_TRUE(parse(gas_text).tables("absent").empty());
}

TEST_F(GasTable, ErrorsNameFileLineAndKey) {
  expect_contains(user_error([&] { gas.number("name"); }),
                  "bed.toml:5: gas.name: is \"air\", but must be a number in (-inf, inf)");
  expect_contains(user_error([&] { gas.number("absent"); }), "gas.absent: is missing");
  expect_contains(user_error([&] { gas.integer("density"); }),
                  "bed.toml:2: gas.density: is 1.2, but must be an integer");
  expect_contains(user_error([&] { gas.text("density"); }), "is 1.2, but must be a string");
  expect_contains(user_error([&] { gas.flag_or("density", true); }),
                  "is 1.2, but must be true or false");
  expect_contains(user_error([&] { gas.vector("words"); }),
                  "bed.toml:9: gas.words: holds \"a\", but must hold finite numbers only");
  expect_contains(user_error([&] { gas.vector("density"); }),
                  "is 1.2, but must be a list of numbers");
  expect_contains(user_error([&] { gas.texts("mixed"); }), "holds 1, but must hold strings only");
  expect_contains(user_error([&] { gas.integers3("velocity"); }),
                  "is [1, 2.5, 3], but must hold three integers");
  expect_contains(user_error([&] { gas.table("density"); }),
                  "is 1.2, but must be a table: [gas.density]");
}

TEST_F(GasTable, ErrorsOfRangesGiveValueAndRange) {
  expect_contains(user_error([&] { gas.number("density", {.lower = 2, .upper = 3}); }),
                  "is 1.2, but must be in [2, 3]");
  expect_contains(user_error([&] { gas.number("density", {.upper = 1.2, .upper_open = true}); }),
                  "but must be in (-inf, 1.2)");
  expect_contains(user_error([&] { gas.integer("steps", {.upper = 6}); }), "6]");
  expect_contains(user_error([&] { gas.integers3("cells", {.lower = 5}); }), "[5, inf)");
}

TEST_F(GasTable, ErrorsOfChoicesSuggestTheNearest) {
  const std::string message = user_error([&] { gas.choice("name", {"aire", "water"}); });
  expect_contains(message, "is 'air', but must be one of: aire, water");
  expect_contains(message, "did you mean 'aire'?");
}

TEST(ConfigTable, RangesKeepTheirEnds) {
  EXPECT_FALSE(Range::positive().contains(0.0));
  EXPECT_TRUE(Range::non_negative().contains(0.0));
  EXPECT_FALSE(Range{}.contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(Range{}.contains(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_EQ((Range{.lower = 0, .upper = 1, .lower_open = true}.text()), "(0, 1]");
}

TEST(ConfigTable, UnknownKeysSuggestTheNearestOrListAll) {
  const ConfigTable gas = parse("[gas]\ndensty = 1\n").table("gas");
  EXPECT_FALSE(gas.has("density"));
  expect_contains(user_error([&] { gas.reject_unknown_keys(); }),
                  "bed.toml:2: gas.densty: is not a known key; did you mean 'density'?");
  const ConfigTable other = parse("[gas]\nzzzzzz = 1\n").table("gas");
  EXPECT_FALSE(other.has("density") || other.has("viscosity"));
  expect_contains(user_error([&] { other.reject_unknown_keys(); }),
                  "known here: density, viscosity");
}

TEST(ConfigTable, KeysThatWereAskedForAreKnown) {
  const ConfigTable gas = parse("[gas]\ndensity = 1\n").table("gas");
  gas.number("density");
  EXPECT_NO_THROW(gas.reject_unknown_keys());
}

TEST(ConfigTable, KnownKeysAreSharedByCopies) {
  const ConfigTable root = parse("a = 1\n");
  const ConfigTable copy = root;
  copy.number("a");
  EXPECT_NO_THROW(root.reject_unknown_keys());
}

TEST(ConfigTable, CountsTheTablesOfAList) {
  const auto bodies = parse("[[body]]\nx = 1\n[[body]]\nx = \"a\"\n").tables("body");
  ASSERT_EQ(bodies.size(), 2U);
  EXPECT_EQ(bodies[0].number("x"), 1);
  expect_contains(user_error([&] { bodies[1].number("x"); }), "bed.toml:4: body[2].x");
  expect_contains(user_error([&] { parse("body = 1").tables("body"); }),
                  "is 1, but must be a list of tables: [[body]]");
  expect_contains(user_error([&] { parse("[gas]").number("gas"); }), "is a table, but must be");
}

TEST(ConfigTable, SyntaxErrorsNameTheLine) {
  expect_contains(user_error([] { parse("a = 1\nb = \n"); }), "bed.toml:2: not valid TOML");
}

TEST(ConfigTable, MissingFilesAndDirectoriesAreUserErrors) {
  expect_contains(user_error([] { ConfigTable::parse_file("/nowhere/bed.toml"); }),
                  "cannot read case file '/nowhere/bed.toml'");
  expect_contains(user_error([] { ConfigTable::parse_file("/tmp"); }), "cannot read case file");
}

TEST(ConfigTable, ResolvesPathsFromTheCaseFile) {
  const ConfigTable table = ConfigTable::parse("", "cases/a/bed.toml");
  EXPECT_EQ(table.resolve_path("x.h5"), "cases/a/x.h5");
  EXPECT_EQ(table.resolve_path("/data/x.h5"), "/data/x.h5");
}

TEST(ConfigTable, statements_are_all_that_a_file_says_under_their_full_keys) {
  const ConfigTable file = parse(
      "[run]\nend = 1\nstep = 0.1\n"
      "[[body]]\nname = 'a'\nsphere = {radius = 2.0, center = [1, 2.5, 3]}\n"
      "[[body]]\nname = 'b'\nfixed = true\n");
  const std::vector<ConfigStatement> expected{{"body[1].name", "\"a\""},
                                              {"body[1].sphere.center", "[1, 2.5, 3]"},
                                              {"body[1].sphere.radius", "2"},
                                              {"body[2].fixed", "true"},
                                              {"body[2].name", "\"b\""},
                                              {"run.end", "1"},
                                              {"run.step", "0.1"}};
  EXPECT_EQ(file.statements(), expected);
  EXPECT_EQ(file.table("run").statements().front().key, "run.end");
  EXPECT_TRUE(file.table_or_empty("absent").statements().empty());
}

}  // namespace
}  // namespace gasgrain
