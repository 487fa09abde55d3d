#include "cfd/field_output.hpp"

#include <algorithm>
#include <vector>

#include "cfd/loops.hpp"

namespace gasgrain::cfd {

namespace {

// term(storage index, component) of the owned cells, components adjacent.
template <class Term>
std::vector<double> owned_values(const Field& like, int components, const Term& term) {
  std::vector<double> values;
  values.reserve(like.count() * components);
  for_each_cell(like.size(), [&](int i, int j, int k) {
    const std::ptrdiff_t n = like.index(i, j, k);
    for (int d = 0; d < components; ++d) values.push_back(term(n, d));
  });
  return values;
}

// velocity(storage index, component) in cells.
template <class Velocity>
void write(FrameWriter& writer, const GasSolver& solver, double time, const Velocity& velocity) {
  const Grid& grid = solver.decomposition().grid();
  const Block& block = solver.decomposition().block();
  GridFrame frame{.cells = grid.cells,
                  .lower = grid.lower,
                  .spacing = grid.spacing(),
                  .block_lower = block.lower,
                  .block_cells = block.size,
                  .arrays = {}};
  const std::vector<std::string>& chosen = solver.gas_case().output.fields;
  std::vector<std::vector<double>> values;  // alive until the frame is written
  const auto add = [&](const char* name, int components, const auto& term) {
    if (std::find(chosen.begin(), chosen.end(), name) == chosen.end()) return;
    values.push_back(owned_values(solver.pressure(), components, term));
    frame.arrays.push_back({name, components, values.back().data()});
  };
  const auto value_of = [](const Field& field) {
    return [&field](std::ptrdiff_t n, int) { return field[n]; };
  };
  add("velocity", 3, velocity);
  add("pressure", 1, value_of(solver.pressure()));
  add("void_fraction", 1, value_of(solver.void_fraction()));
  add("wall_fraction", 1, value_of(solver.walls().wall_fraction));
  writer.write(time, frame);
}

}  // namespace

void write_frame(FrameWriter& writer, const GasSolver& solver, double time) {
  write(writer, solver, time, [&](std::ptrdiff_t n, int d) {
    const Field& u = solver.velocity()[d];
    return 0.5 * (u[n] + u[n + u.stride(d)]);
  });
}

void write_frame(FrameWriter& writer, const GasSolver& solver, double time,
                 const VectorField& velocity_in_cells) {
  write(writer, solver, time, [&](std::ptrdiff_t n, int d) { return velocity_in_cells[d][n]; });
}

}  // namespace gasgrain::cfd
