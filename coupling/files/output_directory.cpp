#include "coupling/files/output_directory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
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

namespace {

// Whether the file still has a name: a run that ends may take it away between our open and lock.
bool is_listed(int file) {
  struct stat status;
  return fstat(file, &status) == 0 && status.st_nlink > 0;
}

}  // namespace

OutputDirectory::OutputDirectory(MPI_Comm communicator, const std::string& directory) {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  run_collectively(communicator, [&] {
    if (rank != 0) return;
    make_output_directory(directory);
    path_ = directory + "/.running";
    lock_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0) {
      throw UserError("cannot write into the output directory '" + directory +
                      "': " + std::strerror(errno) + "; make it writable or give another one");
    }
    const bool refused = flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!refused && is_listed(lock_)) return;
    close(lock_);
    lock_ = -1;
    throw UserError("another run is writing into the output directory '" + directory +
                    "'; wait for its end, stop it, or give this run another directory");
  });
}

OutputDirectory::~OutputDirectory() {
  if (lock_ < 0) return;
  unlink(path_.c_str());
  close(lock_);
}

}  // namespace gasgrain
