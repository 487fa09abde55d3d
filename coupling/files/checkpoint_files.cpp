#include "coupling/files/checkpoint_files.hpp"

#include <filesystem>
#include <utility>

#include "coupling/files/collective_error.hpp"
#include "coupling/shared/complete_file.hpp"

namespace gasgrain {

namespace {

namespace fs = std::filesystem;

constexpr int step_digits = 12;  // the order of names is that of the steps

}  // namespace

CheckpointFiles::CheckpointFiles(MPI_Comm comm, std::string directory, std::string name)
    : comm_(comm),
      directory_(std::move(directory)),
      name_{std::move(name) + '_', ".h5", step_digits} {
  MPI_Comm_rank(comm_, &rank_);
  run_collectively(comm_, [this] {
    if (rank_ != 0) return;
    std::error_code error;
    fs::create_directories(directory_, error);
    if (error || !fs::is_directory(directory_)) {
      throw UserError("cannot create the directory '" + directory_ + "' for checkpoints: " +
                      (error ? error.message() : "there is a file of that name") +
                      "; give another one");
    }
  });
}

std::string CheckpointFiles::write(long step, const std::function<void(Hdf5File&)>& content) {
  const std::string path = (fs::path(directory_) / file_of_step(name_, step)).string();
  const std::string part = path + ".part";
  run_collectively(comm_, [&] {
    Hdf5File file = Hdf5File::create(part, comm_);
    content(file);
    file.flush();
    file.close();
  });
  run_collectively(comm_, [&] {
    if (rank_ != 0) return;
    complete_file(part, path);
    keep_last_two(directory_, name_, step, previous_);
  });
  previous_ = step;
  return path;
}

void CheckpointFiles::continue_from(const std::string& path) {
  const fs::path file(path);
  std::error_code absent;
  const bool is_ours = fs::equivalent(file.has_parent_path() ? file.parent_path() : ".",
                                      directory_.empty() ? "." : directory_, absent);
  previous_ = is_ours ? step_of_file(name_, file.filename().string()) : std::nullopt;
}

std::vector<std::string> CheckpointFiles::found() const {
  std::string joined;
  if (rank_ == 0) {
    for (const StepFile& file : files_of_steps(directory_, name_)) joined += file.path + '\n';
  }
  unsigned long length = joined.size();
  MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, 0, comm_);
  joined.resize(length);
  MPI_Bcast(joined.data(), static_cast<int>(length), MPI_CHAR, 0, comm_);
  std::vector<std::string> paths;
  for (std::size_t from = 0; from < joined.size();) {
    const std::size_t to = joined.find('\n', from);
    paths.push_back(joined.substr(from, to - from));
    from = to + 1;
  }
  return paths;
}

}  // namespace gasgrain
