// Files of a coupled run: time series, frames of gas and grains, summary.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "coupling/bed_layers.hpp"
#include "coupling/dem_host.hpp"
#include "coupling/files/csv_file.hpp"
#include "coupling/files/frame_writer.hpp"
#include "coupling/files/output_directory.hpp"
#include "coupling/files/summary.hpp"

namespace gasgrain::coupling {

struct NamedValue {
  std::string name;
  double value;
};

class RunFiles {
 public:
  // Collective. Makes and holds the directory and removes a summary of an earlier run, so that
  // nothing unfinished looks complete. With `continue_from` [s] the rows up to that time and the
  // frames that are there are kept. Throws UserError on every rank.
  RunFiles(MPI_Comm communicator, const std::string& directory,
           std::optional<double> continue_from);

  // Appends a line to timeseries.csv; the first call fixes the columns. Collective.
  void add_row(const std::vector<NamedValue>& row);
  // Appends the layers to void_fraction_profile.csv. Collective.
  void add_profile(double time, const BedLayers& layers);
  // Appends a frame to gas.xdmf and grains.xdmf. Collective.
  void add_frame(double time, const cfd::GasSolver& gas, const GrainState& grains);
  // Writes summary.json. Rank 0 writes.
  void write(const Summary& summary) const;

  const std::string& directory() const { return directory_; }

 private:
  void open(std::optional<CsvFile>& file, const std::string& name,
            const std::vector<std::string>& columns);

  MPI_Comm communicator_;
  std::string directory_;
  OutputDirectory held_;
  std::optional<double> continue_from_;
  int rank_;
  std::optional<CsvFile> series_, profile_;  // from their first rows on, on rank 0
  bool has_series_ = false, has_profile_ = false;
  FrameWriter gas_frames_, grain_frames_;
};

}  // namespace gasgrain::coupling
