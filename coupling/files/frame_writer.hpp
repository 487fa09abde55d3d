// Time series of fields and grains that ParaView opens: one HDF5 file per frame, one XDMF index.
//
//   FrameWriter gas(comm, "out", "gas");          // out/gas.xdmf, out/gas_000000.h5, ...
//   gas.write(time, GridFrame{...});              // collective
//
// A frame enters the index only when its file is complete and closed, and the index is replaced
// whole, so a job that is killed leaves a readable series. A frame written at a time t replaces the
// frames at and after t, which is what a job restarted before its last frame needs.
#pragma once

#include <mpi.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coupling/shared/vec3.hpp"

namespace gasgrain {

// One named array of this rank: `components` values (1 or 3) per cell or grain, those of one cell
// or grain adjacent. The memory stays the caller's and is read during write() only.
struct NamedArray {
  std::string name;
  int components = 1;
  const double* values = nullptr;
};

// Cell fields of a uniform grid; this rank holds the block [block_lower, block_lower +
// block_cells). The blocks of all ranks tile the grid. Cells of an array are ordered with x
// fastest.
struct GridFrame {
  std::array<int, 3> cells{};   // of the whole grid
  Vec3 lower = Vec3::Zero();    // corner of the grid, m
  Vec3 spacing = Vec3::Ones();  // m
  std::array<int, 3> block_lower{};
  std::array<int, 3> block_cells{};
  std::vector<NamedArray> arrays;  // same names in the same order on every rank
};

// Grains of this rank; the number may differ from rank to rank and be zero.
struct PointFrame {
  std::size_t count = 0;
  const double* positions = nullptr;  // x y z of each grain, m
  const std::int64_t* ids = nullptr;  // one per grain
  std::vector<NamedArray> arrays;     // same names in the same order on every rank
};

enum class Series { start_new, resume };

class FrameWriter {
 public:
  // Collective. Creates the directory. start_new forgets an index that is there; resume continues
  // it (and starts one when there is none). Throws UserError on every rank on failure.
  FrameWriter(MPI_Comm comm, std::string directory, std::string name,
              Series series = Series::start_new);

  // Collective: appends a frame. A name of the series holds either grids or points, not both.
  void write(double time, const GridFrame& frame);
  void write(double time, const PointFrame& frame);

  // Times of the frames in the index, ascending, s.
  std::vector<double> times() const;

 private:
  struct Entry {
    double time;
    int number;       // of the frame's file
    std::string xml;  // its <Grid> element
  };

  int begin_frame(double time);
  void drop_frames_from(double time);
  void finish_frame(double time, int number, const std::string& xml);
  std::string file_name(int number) const;
  std::string path(const std::string& file) const;
  void read_index();
  void write_index() const;

  MPI_Comm comm_;
  int rank_ = 0;
  std::string directory_, name_;
  std::vector<Entry> entries_;
};

}  // namespace gasgrain
