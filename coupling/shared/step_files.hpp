// Files of one directory that belong to steps of a run, PREFIX<step>SUFFIX: which ones there are,
// and the two last ones to keep.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gasgrain {

struct StepFileName {
  std::string prefix, suffix;
  int digits = 0;  // of the step, filled up with zeros; 0: as many as it takes
};

// "gas_" + "000000000010" + ".h5".
std::string file_of_step(const StepFileName& name, long step);

// The step of a file name of that form, digits included.
std::optional<long> step_of_file(const StepFileName& name, const std::string& file);

struct StepFile {
  long step;
  std::string path;
};

// The newest (largest step) first. A directory that cannot be read has none.
std::vector<StepFile> files_of_steps(const std::string& directory, const StepFileName& name);

// Removes the files of that form but those of the step `newest` and of the one `before` it.
// Files that cannot be removed stay: one too many does no harm.
void keep_last_two(const std::string& directory, const StepFileName& name, long newest,
                   std::optional<long> before);

}  // namespace gasgrain
