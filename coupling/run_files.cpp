#include "coupling/run_files.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "cfd/loops.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

int rank_in(MPI_Comm communicator) {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  return rank;
}

// Owned cells of some fields, the values of a cell adjacent.
std::vector<double> owned_values(const std::vector<const cfd::Field*>& fields) {
  const cfd::Index3 size = fields[0]->size();
  std::vector<double> values;
  values.reserve(fields.size() * size[0] * size[1] * size[2]);
  cfd::for_each_cell(size, [&](int i, int j, int k) {
    for (const cfd::Field* field : fields) values.push_back((*field)(i, j, k));
  });
  return values;
}

}  // namespace

RunFiles::RunFiles(MPI_Comm communicator, const std::string& directory, Series series, double from)
    : directory_(directory),
      rank_(rank_in(communicator)),
      gas_frames_(communicator, directory, "gas", series),
      grain_frames_(communicator, directory, "grains", series) {
  int failed = 0;
  if (rank_ == 0) {
    std::error_code ignored;  // an absent file is as good as a removed one
    std::filesystem::remove(directory_ + "/summary.json", ignored);
    open_series(series, from);
    failed = !series_;
  }
  MPI_Bcast(&failed, 1, MPI_INT, 0, communicator);
  if (failed) {
    throw UserError("cannot write '" + directory_ +
                    "/timeseries.csv'; check that the output directory is writable");
  }
}

// The first column of a row is its time; a row that was cut off by a kill has no line end.
void RunFiles::open_series(Series series, double from) {
  const std::string path = directory_ + "/timeseries.csv";
  std::vector<std::string> kept;
  if (series == Series::resume) {
    std::ifstream old(path);
    for (std::string line; std::getline(old, line) && !old.eof();) {
      constexpr double rounding = 1e-9;  // of the printed time
      if (kept.empty() || std::strtod(line.c_str(), nullptr) <= from * (1.0 + rounding))
        kept.push_back(line);
    }
  }
  series_.open(path);
  for (const std::string& line : kept) series_ << line << '\n';
  series_ << std::flush;
  has_header_ = !kept.empty();
}

void RunFiles::add_row(const std::vector<NamedValue>& row) {
  if (rank_ != 0) return;
  if (!has_header_) {
    for (std::size_t n = 0; n < row.size(); ++n) series_ << (n ? "," : "") << row[n].name;
    series_ << '\n';
    has_header_ = true;
  }
  char number[32];
  for (std::size_t n = 0; n < row.size(); ++n) {
    std::snprintf(number, sizeof number, "%.10g", row[n].value);
    series_ << (n ? "," : "") << number;
  }
  series_ << '\n' << std::flush;
}

void RunFiles::add_frame(double time, const cfd::GasSolver& gas, const GrainState& grains) {
  const cfd::Decomposition& decomposition = gas.decomposition();
  const cfd::Index3 size = decomposition.block().size;
  cfd::VectorField velocity, gradient;
  for (int d = 0; d < 3; ++d) velocity[d] = gradient[d] = cfd::Field(size);
  gas.sample_at_cells(velocity, gradient);
  const auto velocities = owned_values({&velocity[0], &velocity[1], &velocity[2]});
  const auto pressures = owned_values({&gas.pressure()});
  const auto void_fractions = owned_values({&gas.void_fraction()});
  const auto wall_fractions = owned_values({&gas.walls().wall_fraction});

  GridFrame cells;
  cells.cells = decomposition.grid().cells;
  cells.lower = decomposition.grid().lower;
  cells.spacing = decomposition.grid().spacing();
  cells.block_lower = decomposition.block().lower;
  cells.block_cells = size;
  cells.arrays = {{"velocity", 3, velocities.data()},
                  {"pressure", 1, pressures.data()},
                  {"void_fraction", 1, void_fractions.data()},
                  {"wall_fraction", 1, wall_fractions.data()}};
  gas_frames_.write(time, cells);

  PointFrame points;
  points.count = grains.ids.size();
  points.positions = grains.positions.data();
  points.ids = grains.ids.data();
  points.arrays = {{"velocity", 3, grains.velocities.data()},
                   {"radius", 1, grains.radii.data()},
                   {"type", 1, grains.types.data()}};
  grain_frames_.write(time, points);
}

void RunFiles::write(const Summary& summary) const {
  if (rank_ == 0) write_summary(directory_ + "/summary.json", summary);
}

}  // namespace gasgrain::coupling
