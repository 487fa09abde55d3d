// Uses our style headers as a LIGGGHTS source tree does (modify.cpp and input.cpp with their
// style_fix.h and style_command.h): once for the classes, then under FIX_CLASS or COMMAND_CLASS for
// the entries of the table of styles.
#include <fix.h>
#include <gtest/gtest.h>

#include <string>
#include <type_traits>
#include <vector>

#include "coupling/fix_couple_gas.h"
#include "liggghts_plugins/coarsegraining.h"
#include "liggghts_plugins/fix_wall_sdf.h"

using namespace LAMMPS_NS;  // NOLINT: as LIGGGHTS's sources do

namespace {

TEST(StyleHeaders, ListFixesUnderFixClass) {
  std::vector<std::string> names;
#define FIX_CLASS
#define FixStyle(key, Class)                    \
  static_assert(std::is_base_of_v<Fix, Class>); \
  names.push_back(#key);
#include "coupling/fix_couple_gas.h"
#include "liggghts_plugins/fix_wall_sdf.h"
#undef FixStyle
#undef FIX_CLASS
  EXPECT_EQ(names, (std::vector<std::string>{"couple/gas", "wall/sdf"}));
}

TEST(StyleHeaders, ListCommandsUnderCommandClass) {
  std::vector<std::string> names;
#define COMMAND_CLASS
#define CommandStyle(key, Class)         \
  static_assert(std::is_class_v<Class>); \
  names.push_back(#key);
#include "liggghts_plugins/coarsegraining.h"
#undef CommandStyle
#undef COMMAND_CLASS
  EXPECT_EQ(names, (std::vector<std::string>{"coarsegraining"}));
}

}  // namespace
