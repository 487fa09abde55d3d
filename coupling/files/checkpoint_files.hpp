// The checkpoint files of a run: <directory>/<name>_<step>.h5, the last two.
//
//   CheckpointFiles files(comm, "out", "gas_checkpoint");
//   files.write(step, [&](Hdf5File& file) { ... });      // collective
//
// A file gets its name only when it is complete and on the disk, and the older ones go only then:
// a job that is killed at any moment, or a machine that stops, leaves the last complete one.
#pragma once

#include <mpi.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coupling/files/hdf5_file.hpp"
#include "coupling/shared/step_files.hpp"

namespace gasgrain {

class CheckpointFiles {
 public:
  // Collective. Creates the directory. Throws UserError on every rank.
  CheckpointFiles(MPI_Comm comm, std::string directory, std::string name);

  // Writes the checkpoint of a step, then removes all others of this name in the directory but the
  // one written or continued from before. Returns the path of the file. Collective; throws
  // UserError.
  std::string write(long step, const std::function<void(Hdf5File&)>& content);

  // The run goes on from that file: it is the one to keep beside the next.
  void continue_from(const std::string& path);

  // Paths of the checkpoints there are, the newest (largest step) first; the same on every rank.
  // Collective.
  std::vector<std::string> found() const;

 private:
  MPI_Comm comm_;
  int rank_ = 0;
  std::string directory_;
  StepFileName name_;
  std::optional<long> previous_;  // step of the one to keep
};

}  // namespace gasgrain
