#include "coupling/bed_layers.hpp"

#include <gtest/gtest.h>

namespace gasgrain::coupling {
namespace {

// Five layers of 1 cm, ten cells each; the third is half closed, the fifth empty.
BedLayers layers() {
  return {.thickness = 0.01,
          .cell_volume = 1e-6,
          .open_cells = {10, 10, 5, 10, 10},
          .void_fraction = {0.4, 0.4, 0.5, 0.9, 1.0}};
}

TEST(BedLayers, level_lies_between_the_middles_of_layers) {
  // 0.8 is three quarters of the way from 0.5 at 25 mm to 0.9 at 35 mm
  EXPECT_NEAR(level_of_void_fraction(layers(), 0.8), 0.0325, 1e-15);
  EXPECT_NEAR(level_of_void_fraction(layers(), 0.45), 0.02, 1e-15);
}

TEST(BedLayers, level_passes_over_closed_layers) {
  BedLayers bed = layers();
  bed.open_cells[3] = 0;  // 0.5 at 25 mm, 1 at 45 mm
  EXPECT_NEAR(level_of_void_fraction(bed, 0.75), 0.035, 1e-15);
}

TEST(BedLayers, level_of_a_full_and_of_an_empty_grid) {
  BedLayers bed = layers();
  bed.void_fraction = {0.4, 0.4, 0.4, 0.4, 0.4};
  EXPECT_NEAR(level_of_void_fraction(bed, 0.8), 0.05, 1e-15);
  bed.void_fraction = {1, 1, 1, 1, 1};
  EXPECT_EQ(level_of_void_fraction(bed, 0.8), 0.0);
  EXPECT_EQ(level_of_solid_share(bed, 0.99), 0.0);
  EXPECT_EQ(centre_of_solid(bed), 0.0);
}

TEST(BedLayers, heights_by_solid_volume) {
  // solid cells: 6, 6, 2.5, 1, 0
  EXPECT_NEAR(level_of_solid_share(layers(), 6.0 / 15.5), 0.01, 1e-15);
  EXPECT_NEAR(level_of_solid_share(layers(), 13.25 / 15.5), 0.025, 1e-15);
  EXPECT_NEAR(centre_of_solid(layers()), (6 * 0.005 + 6 * 0.015 + 2.5 * 0.025 + 1 * 0.035) / 15.5,
              1e-15);
}

TEST(BedLayers, open_volume_counts_parts_of_layers) {
  EXPECT_NEAR(open_volume_below(layers(), 0.025), 22.5e-6, 1e-18);
}

}  // namespace
}  // namespace gasgrain::coupling
