#include "coupling/run_files.hpp"

#include <array>
#include <filesystem>

#include "cfd/field_output.hpp"
#include "coupling/files/collective_error.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::coupling {

namespace {

int rank_in(MPI_Comm communicator) {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  return rank;
}

}  // namespace

RunFiles::RunFiles(MPI_Comm communicator, const std::string& directory,
                   std::optional<double> continue_from)
    : communicator_(communicator),
      directory_(directory),
      held_(communicator, directory),
      continue_from_(continue_from),
      rank_(rank_in(communicator)),
      gas_frames_(communicator, directory, "gas",
                  continue_from ? Series::resume : Series::start_new),
      grain_frames_(communicator, directory, "grains",
                    continue_from ? Series::resume : Series::start_new) {
  run_collectively(communicator, [&] {
    if (rank_ != 0) return;
    std::error_code ignored;  // an absent file is as good as a removed one
    std::filesystem::remove(directory_ + "/summary.json", ignored);
  });
}

void RunFiles::open(std::optional<CsvFile>& file, const std::string& name,
                    const std::vector<std::string>& columns) {
  run_collectively(communicator_, [&] {
    if (rank_ == 0) file.emplace(directory_ + "/" + name, columns, continue_from_);
  });
}

void RunFiles::add_row(const std::vector<NamedValue>& row) {
  if (!has_series_) {
    std::vector<std::string> columns;
    for (const NamedValue& value : row) columns.push_back(value.name);
    open(series_, "timeseries.csv", columns);
    has_series_ = true;
  }
  run_collectively(communicator_, [&] {
    if (!series_) return;
    std::vector<double> values;
    for (const NamedValue& value : row) values.push_back(value.value);
    series_->add(values);
    series_->flush();
  });
}

void RunFiles::add_profile(double time, const BedLayers& layers) {
  if (!has_profile_)
    open(profile_, "void_fraction_profile.csv", {"time", "height", "void_fraction"});
  has_profile_ = true;
  run_collectively(communicator_, [&] {
    if (!profile_) return;
    for (std::size_t layer = 0; layer < layers.count(); ++layer)
      profile_->add(std::array{time, layers.middle(layer), layers.void_fraction[layer]});
    profile_->flush();
  });
}

void RunFiles::add_frame(double time, const cfd::GasSolver& gas, const GrainState& grains) {
  const cfd::Index3 size = gas.decomposition().block().size;
  cfd::VectorField velocity, gradient;
  for (int d = 0; d < 3; ++d) velocity[d] = gradient[d] = cfd::Field(size);
  gas.sample_at_cells(velocity, gradient);
  cfd::write_frame(gas_frames_, gas, time, velocity);

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
