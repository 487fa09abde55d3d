#include "coupling/files/output_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "coupling/files/collective_error.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain {

void make_output_directory(const std::string& directory) {
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error || !std::filesystem::is_directory(directory)) {
    throw UserError("cannot create the output directory '" + directory + "': " + error.message());
  }
}

OutputDirectory::OutputDirectory(MPI_Comm communicator, const std::string& directory) {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  run_collectively(communicator, [&] {
    if (rank != 0) return;
    make_output_directory(directory);
    const std::string path = directory + "/.running";
    lock_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0) throw UserError("cannot write into the output directory '" + directory + "'");
    if (flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    close(lock_);
    lock_ = -1;
    throw UserError("another run is writing into the output directory '" + directory +
                    "'; wait for its end, stop it, or give this run another directory");
  });
}

OutputDirectory::~OutputDirectory() {
  if (lock_ >= 0) close(lock_);
}

}  // namespace gasgrain
