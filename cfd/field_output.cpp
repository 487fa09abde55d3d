#include "cfd/field_output.hpp"

#include <vector>

#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

std::vector<double> owned_values(const Field& field) {
  std::vector<double> values;
  for_each_cell(field.size(), [&](int i, int j, int k) { values.push_back(field(i, j, k)); });
  return values;
}

// Mean of the two faces of each direction.
std::vector<double> centred_velocity(const VectorField& velocity) {
  std::vector<double> values;
  for_each_cell(velocity[0].size(), [&](int i, int j, int k) {
    for (int d = 0; d < 3; ++d) {
      const std::ptrdiff_t n = velocity[d].index(i, j, k);
      values.push_back(0.5 * (velocity[d][n] + velocity[d][n + velocity[d].stride(d)]));
    }
  });
  return values;
}

}  // namespace

void write_frame(FrameWriter& writer, const GasSolver& solver, double time) {
  const Grid& grid = solver.decomposition().grid();
  const Block& block = solver.decomposition().block();
  const std::vector<double> velocity = centred_velocity(solver.velocity());
  const std::vector<double> pressure = owned_values(solver.pressure());
  const std::vector<double> void_fraction = owned_values(solver.void_fraction());
  const std::vector<double> wall_fraction = owned_values(solver.walls().wall_fraction);
  writer.write(time, GridFrame{.cells = grid.cells,
                               .lower = grid.lower,
                               .spacing = grid.spacing(),
                               .block_lower = block.lower,
                               .block_cells = block.size,
                               .arrays = {{"velocity", 3, velocity.data()},
                                          {"pressure", 1, pressure.data()},
                                          {"void_fraction", 1, void_fraction.data()},
                                          {"wall_fraction", 1, wall_fraction.data()}}});
}

}  // namespace gasgrain::cfd
