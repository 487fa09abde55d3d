#include "coupling/grain_transfer.hpp"

#include <gtest/gtest.h>

#include "mapping_fixture.hpp"

namespace gasgrain::coupling {
namespace {

GrainRecord record(const Vec3& position, double number) {
  return {.position = position,
          .velocity = Vec3(number, 0, 0),
          .volume = 1e-9,
          .mass = 2.5e-6,
          .original_diameter = 1e-4};
}

// Grain n starts on rank n modulo ranks, wherever it is.
std::vector<GrainRecord> dealt_out(const MappingScene& scene, const std::vector<Vec3>& places) {
  std::vector<GrainRecord> mine;
  for (std::size_t n = 0; n < places.size(); ++n) {
    if (static_cast<int>(n) % scene.decomposition.size() == scene.decomposition.rank()) {
      mine.push_back(record(places[n], double(n)));
    }
  }
  return mine;
}

TEST(GrainTransfer, every_grain_reaches_the_owner_of_its_cell_once) {
  const MappingScene scene;
  GrainTransfer transfer(scene.decomposition);
  const std::vector<Vec3> places = scene.places(997);
  transfer.send(dealt_out(scene, places));
  double numbers = 0;
  for (const GrainRecord& grain : transfer.received()) {
    EXPECT_TRUE(scene.owns(grain.position));
    EXPECT_EQ(grain.position, places[static_cast<std::size_t>(grain.velocity[0])]);
    numbers += grain.velocity[0];
  }
  EXPECT_EQ(scene.sum(double(transfer.received().size())), 997);
  EXPECT_EQ(scene.sum(numbers), 996 * 997 / 2);
  EXPECT_EQ(transfer.outside(), 0);
}

TEST(GrainTransfer, results_come_back_to_their_grains) {
  const MappingScene scene;
  GrainTransfer transfer(scene.decomposition);
  const std::vector<GrainRecord> mine = dealt_out(scene, scene.places(500));
  transfer.send(mine);
  std::vector<Vec3> results;
  for (const GrainRecord& grain : transfer.received()) {
    results.push_back(Vec3(grain.velocity[0], 2 * grain.velocity[0], grain.position[2]));
  }
  std::vector<Vec3> forces(mine.size(), Vec3::Zero());
  transfer.return_to_senders(forces, results);
  for (std::size_t n = 0; n < mine.size(); ++n) {
    EXPECT_EQ(forces[n], Vec3(mine[n].velocity[0], 2 * mine[n].velocity[0], mine[n].position[2]));
  }
}

TEST(GrainTransfer, order_is_that_of_ranks_and_senders) {
  const MappingScene scene;
  GrainTransfer transfer(scene.decomposition);
  transfer.send(dealt_out(scene, scene.places(500)));
  const int ranks = scene.decomposition.size();
  for (std::size_t n = 1; n < transfer.received().size(); ++n) {
    const int before = static_cast<int>(transfer.received()[n - 1].velocity[0]);
    const int now = static_cast<int>(transfer.received()[n].velocity[0]);
    EXPECT_TRUE(before % ranks < now % ranks || (before % ranks == now % ranks && before < now));
  }
}

TEST(GrainTransfer, grains_outside_the_grid_stay_and_keep_their_result) {
  const MappingScene scene;
  GrainTransfer transfer(scene.decomposition);
  const std::vector<GrainRecord> mine{record(scene.grid.upper + Vec3(0, 0, 0.01), 0),
                                      record(scene.grid.lower - Vec3(5, 0, 0), 1)};
  transfer.send(mine);
  EXPECT_EQ(transfer.outside(), 2);
  EXPECT_TRUE(transfer.received().empty());
  std::vector<Vec3> forces(2, Vec3(1, 2, 3));
  transfer.return_to_senders(forces, {});
  EXPECT_EQ(forces[0], Vec3(1, 2, 3));
}

TEST(GrainTransfer, wraps_positions_in_periodic_directions) {
  const MappingScene scene({13, 9, 11}, {true, false, false}, {});
  GrainTransfer transfer(scene.decomposition);
  const Vec3 inside = scene.grid.lower + Vec3(0.05, 0.05, 0.05);
  std::vector<GrainRecord> mine;
  if (scene.decomposition.rank() == 0) mine.push_back(record(inside - Vec3(2 * 1.3, 0, 0), 0));
  transfer.send(mine);
  for (const GrainRecord& grain : transfer.received()) {
    EXPECT_NEAR((grain.position - inside).norm(), 0.0, 1e-12);
  }
  EXPECT_EQ(scene.sum(double(transfer.received().size())), 1);
}

TEST(GrainTransfer, a_rank_without_grains_takes_part) {
  const MappingScene scene;
  GrainTransfer transfer(scene.decomposition);
  std::vector<GrainRecord> mine;
  if (scene.decomposition.rank() == scene.decomposition.size() - 1) {
    for (const Vec3& x : scene.places(100)) mine.push_back(record(x, 0));
  }
  transfer.send(mine);
  EXPECT_EQ(scene.sum(double(transfer.received().size())), 100);
}

}  // namespace
}  // namespace gasgrain::coupling
