#include "coupling/shared/step_files.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace gasgrain {

namespace fs = std::filesystem;

std::string file_of_step(const StepFileName& name, long step) {
  std::string digits = std::to_string(step);
  const auto wanted = static_cast<std::size_t>(name.digits);
  if (digits.size() < wanted) digits.insert(0, wanted - digits.size(), '0');
  return name.prefix + digits + name.suffix;
}

std::optional<long> step_of_file(const StepFileName& name, const std::string& file) {
  if (file.size() <= name.prefix.size() + name.suffix.size()) return std::nullopt;
  const char* const begin = file.data() + name.prefix.size();
  const char* const end = file.data() + file.size() - name.suffix.size();
  long step = 0;
  const auto [rest, error] = std::from_chars(begin, end, step);
  if (error != std::errc() || rest != end || step < 0) return std::nullopt;
  return file_of_step(name, step) == file ? std::optional(step) : std::nullopt;
}

std::vector<StepFile> files_of_steps(const std::string& directory, const StepFileName& name) {
  std::vector<StepFile> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error)) {
    if (const std::optional<long> step = step_of_file(name, entry.path().filename().string()))
      files.push_back({*step, entry.path().string()});
  }
  std::sort(files.begin(), files.end(),
            [](const StepFile& a, const StepFile& b) { return a.step > b.step; });
  return files;
}

void keep_last_two(const std::string& directory, const StepFileName& name, long newest,
                   std::optional<long> before) {
  for (const StepFile& file : files_of_steps(directory, name)) {
    std::error_code ignored;
    if (file.step != newest && file.step != before) fs::remove(file.path, ignored);
  }
}

}  // namespace gasgrain
