// A grid with a cylinder in it, grains at random places, and sums over ranks.
#pragma once

#include <mpi.h>

#include <random>
#include <vector>

#include "cfd/halo_exchange.hpp"
#include "cfd/wall_geometry.hpp"
#include "coupling/shared/primitives.hpp"

namespace gasgrain::coupling {

struct MappingScene {
  cfd::Grid grid;
  cfd::Decomposition decomposition;
  cfd::WallGeometry walls;

  explicit MappingScene(const cfd::Index3& cells = {13, 9, 11},
                        const std::array<bool, 3>& periodic = {false, false, false},
                        const std::vector<Body>& bodies = {cylinder()},
                        MPI_Comm communicator = MPI_COMM_WORLD)
      : grid{.lower = Vec3(-0.2, 0.1, 0.0),
             .upper = Vec3(-0.2, 0.1, 0.0) + 0.1 * Vec3(cells[0], cells[1], cells[2]),
             .cells = cells},
        decomposition(communicator, grid, periodic),
        walls(cfd::make_wall_geometry(decomposition,
                                      cfd::SideConditions(grid, boundaries(periodic)), bodies)) {}

  static cfd::Boundaries boundaries(const std::array<bool, 3>& periodic) {
    cfd::Boundaries result;
    for (int d = 0; d < 3; ++d) {
      for (auto& side : result[d]) {
        side.type = periodic[d] ? cfd::BoundaryType::periodic : cfd::BoundaryType::no_slip;
      }
    }
    return result;
  }

  // A tube across the grid, off the grid lines.
  static Body cylinder() {
    Body body;
    body.name = "tube";
    body.shape = make_shape(Cylinder{.center = Vec3(0.43, 0.5, 0.52),
                                     .axis = Vec3(0, 1, 0),
                                     .radius = 0.23,
                                     .half_length = 10});
    return body;
  }

  // Places in the open space, the same on every rank; grains of this rank are those in its block.
  std::vector<Vec3> places(int count) const {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Vec3> result;
    const Body body = cylinder();
    while (static_cast<int>(result.size()) < count) {
      const Vec3 at(share(random), share(random), share(random));
      const Vec3 x = grid.lower + at.cwiseProduct(grid.upper - grid.lower);
      if (!walls.has_bodies || body.shape->distance(x) > 0) result.push_back(x);
    }
    return result;
  }

  bool owns(const Vec3& x) const {
    return decomposition.owner(grid.cell_of(x)) == decomposition.rank();
  }

  double sum(double value) const { return cfd::sum_over_ranks(decomposition, value); }
};

}  // namespace gasgrain::coupling
