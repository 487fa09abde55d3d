// Files of a coupled run: time series, frames of gas and grains, summary.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "coupling/dem_host.hpp"
#include "coupling/files/frame_writer.hpp"
#include "coupling/files/summary.hpp"

namespace gasgrain::coupling {

struct NamedValue {
  const char* name;
  double value;
};

class RunFiles {
 public:
  // Collective. Creates the directory and removes a summary of an earlier run, so that nothing
  // unfinished looks complete. Series::resume keeps the rows of timeseries.csv up to the time
  // `from`, s, and the frames that are there. Throws UserError on every rank.
  RunFiles(MPI_Comm communicator, const std::string& directory, Series series = Series::start_new,
           double from = 0.0);

  // Appends a line to timeseries.csv; the first call fixes the columns. Rank 0 writes.
  void add_row(const std::vector<NamedValue>& row);
  // Appends a frame to gas.xdmf and grains.xdmf. Collective.
  void add_frame(double time, const cfd::GasSolver& gas, const GrainState& grains);
  // Writes summary.json. Rank 0 writes.
  void write(const Summary& summary) const;

  const std::string& directory() const { return directory_; }

 private:
  void open_series(Series series, double from);

  std::string directory_;
  int rank_;
  std::ofstream series_;
  FrameWriter gas_frames_, grain_frames_;
  bool has_header_ = false;
};

}  // namespace gasgrain::coupling
