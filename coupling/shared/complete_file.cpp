#include "coupling/shared/complete_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "coupling/shared/error.hpp"

namespace gasgrain {

void put_on_disk(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY);
  const bool done = file >= 0 && fsync(file) == 0;
  if (file >= 0) close(file);
  if (!done) throw UserError("cannot write '" + path + "' to the disk; is it full?");
}

void complete_file(const std::string& part, const std::string& path) {
  put_on_disk(part);
  std::error_code error;
  std::filesystem::rename(part, path, error);
  if (error) throw UserError("cannot write '" + path + "': " + error.message());
  const std::filesystem::path directory = std::filesystem::path(path).parent_path();
  put_on_disk(directory.empty() ? "." : directory.string());
}

}  // namespace gasgrain
