#include "coupling/files/checkpoint_files.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "coupling/files/collective_error.hpp"
#include "coupling/shared/complete_file.hpp"

namespace gasgrain {

namespace {

namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
  std::error_code absent;
  return !a.empty() && !b.empty() && fs::equivalent(a, b, absent);
}

// The file name with its step in twelve digits: the order of names is that of the steps.
std::string file_name(const std::string& name, long step) {
  std::array<char, 32> digits{};
  std::snprintf(digits.data(), digits.size(), "_%012ld.h5", step);
  return name + digits.data();
}

bool is_checkpoint(const std::string& file, const std::string& name) {
  return file.size() == file_name(name, 0).size() && file.compare(0, name.size(), name) == 0 &&
         file.find_first_not_of("0123456789", name.size() + 1) == file.size() - 3;
}

}  // namespace

CheckpointFiles::CheckpointFiles(MPI_Comm comm, std::string directory, std::string name)
    : comm_(comm), directory_(std::move(directory)), name_(std::move(name)) {
  MPI_Comm_rank(comm_, &rank_);
  run_collectively(comm_, [this] {
    if (rank_ != 0) return;
    std::error_code error;
    fs::create_directories(directory_, error);
    if (error || !fs::is_directory(directory_)) {
      throw UserError("cannot create the directory '" + directory_ + "' for checkpoints");
    }
  });
}

std::string CheckpointFiles::write(long step, const std::function<void(Hdf5File&)>& content) {
  const std::string path = (fs::path(directory_) / file_name(name_, step)).string();
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
    remove_all_but(path);
  });
  previous_ = path;
  return path;
}

void CheckpointFiles::continue_from(const std::string& path) {
  previous_ = path;
}

void CheckpointFiles::remove_all_but(const std::string& newest) const {
  for (const std::string& path : list()) {
    if (same_file(path, newest) || same_file(path, previous_)) continue;
    std::error_code ignored;  // one too many does no harm
    fs::remove(path, ignored);
  }
}

std::vector<std::string> CheckpointFiles::list() const {
  std::vector<std::string> paths;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_, error)) {
    if (is_checkpoint(entry.path().filename().string(), name_)) {
      paths.push_back(entry.path().string());
    }
  }
  std::sort(paths.rbegin(), paths.rend());
  return paths;
}

std::vector<std::string> CheckpointFiles::found() const {
  std::string joined;
  if (rank_ == 0) {
    for (const std::string& path : list()) joined += path + '\n';
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
