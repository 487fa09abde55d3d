// The directory of a run's results: made, and held by one run at a time.
#pragma once

#include <mpi.h>

#include <string>

namespace gasgrain {

// Makes the directory and those above it. Throws UserError when that is not possible.
void make_output_directory(const std::string& directory);

// While it lives no other process can hold the same directory: two runs that write the same files
// would leave a mixture of both. The lock lies on the file `.running` and ends with the process,
// however that ends; one that was killed leaves the file. File systems without locks (some network
// mounts) are not protected.
class OutputDirectory {
 public:
  // Collective; rank 0 makes and holds the directory. Throws UserError on every rank when it cannot
  // be made, or when another run holds it.
  OutputDirectory(MPI_Comm communicator, const std::string& directory);
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory&) = delete;
  OutputDirectory& operator=(const OutputDirectory&) = delete;

 private:
  std::string path_;  // of the lock
  int lock_ = -1;     // file descriptor on rank 0
};

}  // namespace gasgrain
