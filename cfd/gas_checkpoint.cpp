// Whether a checkpoint fits the case is asked twice: of what the two case files say, for a message
// that names the key, and of the sampled bodies, because a file that a body names may have changed.
#include "cfd/gas_checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "cfd/halo_exchange.hpp"
#include "cfd/loops.hpp"
#include "cfd/state_file.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

namespace {

constexpr const char* format = "gasgrain gas checkpoint";
constexpr std::int32_t version = 4;
constexpr double same_fraction = 1e-9;  // of a cell; other ranks round alike

const std::vector<std::string> fixed_sections{"grid.", "gas.", "body[", "fixed_bed."};
const std::vector<std::string> free_sections{"boundary.", "numerics."};

// "key = value" lines; line breaks inside a value would end it.
std::string to_text(const std::vector<ConfigStatement>& statements) {
  std::string text;
  for (const ConfigStatement& statement : statements) {
    std::string value = statement.value;
    std::replace(value.begin(), value.end(), '\n', ' ');
    text += statement.key + " = " + value + "\n";
  }
  return text;
}

std::vector<ConfigStatement> from_text(const std::string& text) {
  std::vector<ConfigStatement> statements;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(" = ");
    if (at != std::string::npos) statements.push_back({line.substr(0, at), line.substr(at + 3)});
  }
  return statements;
}

// The present case as it would come back from a file.
std::vector<ConfigStatement> statements_of(const GasSolver& solver) {
  return from_text(to_text(solver.gas_case().statements));
}

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw UserError("cannot continue from '" + path + "': " + reason +
                  "; restore what it was, or start anew without a restart");
}

void check_format(const Hdf5File& file, const std::string& path) {
  if (!file.has_attribute("format") || file.text_attribute("format") != format) {
    throw UserError("'" + path + "' is not a checkpoint of gasgrain-gas; give one, or \"latest\"");
  }
  const std::vector<std::int32_t> number = file.attribute<std::int32_t>("version");
  if (number != std::vector{version}) {
    throw UserError("'" + path + "' is a checkpoint of format " +
                    (number.empty() ? "?" : std::to_string(number[0])) + ", this program reads " +
                    std::to_string(version) + "; continue it with the program that wrote it");
  }
}

std::vector<std::int32_t> shape(const Decomposition& decomposition) {
  std::vector<std::int32_t> result;
  for (int d = 0; d < 3; ++d) {
    result.push_back(decomposition.grid().cells[d]);
    result.push_back(decomposition.periodic()[d] ? 1 : 0);
  }
  return result;
}

std::string text_of_shape(const std::vector<std::int32_t>& shape) {
  std::string text;
  for (std::size_t d = 0; d + 1 < shape.size(); d += 2) {
    text += (text.empty() ? "" : " x ") + std::to_string(shape[d]) +
            (shape[d + 1] != 0 ? " (periodic)" : "");
  }
  return text;
}

void check_case(const Hdf5File& file, const std::string& path, const GasSolver& solver) {
  const std::vector<ConfigStatement> before = from_text(file.read_text("case"));
  const std::vector<std::string> changed =
      differences(before, statements_of(solver), fixed_sections);
  if (!changed.empty()) {
    const std::string others =
        changed.size() > 1 ? " (and " + std::to_string(changed.size() - 1) + " more)" : "";
    refuse(path, changed.front() + others);
  }
  const std::vector<std::int32_t> was = file.attribute<std::int32_t>("shape");
  const std::vector<std::int32_t> is = shape(solver.decomposition());
  if (was != is) {
    refuse(path, "its grid is " + text_of_shape(was) + ", that of the case " + text_of_shape(is));
  }
}

// The bodies' shapes, which may come from files.
void check_walls(Hdf5File& file, const std::string& path, const GasSolver& solver) {
  const Decomposition& decomposition = solver.decomposition();
  Field before(decomposition.block().size);
  StateFile archive(file, "walls", decomposition, StateDirection::restore);
  archive.cells("wall_fraction", before);
  double largest = 0.0;
  for_each_cell(before.size(), [&](int i, int j, int k) {
    largest = std::max(largest, std::abs(before(i, j, k) - solver.walls().wall_fraction(i, j, k)));
  });
  largest = max_over_ranks(decomposition, largest);
  if (largest <= same_fraction) return;
  std::ostringstream reason;
  reason << "the bodies have another shape: their share of a cell differs by up to " << largest
         << " (has a file that a body names changed?)";
  refuse(path, reason.str());
}

}  // namespace

void RunCounters::visit_state(StateArchive& archive) {
  archive.number_of("steps", steps);
  archive.number_of("iterations", iterations);
  archive.number_of("viscous_iterations", viscous_iterations);
  archive.number_of("fallbacks", fallbacks);
  archive.number_of("shortened", shortened);
  archive.number("largest_divergence", largest_divergence);
  archive.number("largest_removed_mean", largest_removed_mean);
  archive.number("largest_swept_imbalance", largest_swept_imbalance);
  for (int n = 0; n < step_limit_count; ++n) {
    archive.number_of(std::string("limited_by_") + name_of(static_cast<StepLimit>(n)), limited[n]);
  }
  archive.number_of("backflow_steps", backflow_steps);
  archive.number("largest_backflow", largest_backflow);
}

void write_checkpoint(Hdf5File& file, GasSolver& solver, RunCounters& counters) {
  const Decomposition& decomposition = solver.decomposition();
  file.write_attribute("format", format);
  file.write_attribute<std::int32_t>("version", {version});
  file.write_attribute<double>("time", {solver.time()});
  file.write_attribute<std::int32_t>("shape", shape(decomposition));
  file.write_text("case", to_text(solver.gas_case().statements));
  StateFile run(file, "run", decomposition, StateDirection::save);
  counters.visit_state(run);
  StateFile gas(file, "gas", decomposition, StateDirection::save);
  solver.visit_state(gas);
  StateFile walls(file, "walls", decomposition, StateDirection::save);
  Field wall_fraction = solver.walls().wall_fraction;
  walls.cells("wall_fraction", wall_fraction);
}

std::vector<std::string> read_checkpoint(const std::string& path, GasSolver& solver,
                                         RunCounters& counters) {
  Hdf5File file = Hdf5File::open(path, solver.decomposition().communicator());
  check_format(file, path);
  check_case(file, path, solver);
  StateFile run(file, "run", solver.decomposition(), StateDirection::restore);
  counters.visit_state(run);
  StateFile gas(file, "gas", solver.decomposition(), StateDirection::restore);
  solver.visit_state(gas);
  check_walls(file, path, solver);
  return differences(from_text(file.read_text("case")), statements_of(solver), free_sections);
}

std::string first_whole_checkpoint(MPI_Comm communicator, const std::vector<std::string>& paths) {
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  int chosen = static_cast<int>(paths.size());
  for (int n = 0; rank == 0 && n < chosen; ++n) {
    try {
      check_format(Hdf5File::open(paths[n]), paths[n]);
      chosen = n;
    } catch (const UserError&) {
      continue;  // cut short, or not ours: the next older one
    }
  }
  MPI_Bcast(&chosen, 1, MPI_INT, 0, communicator);
  return chosen < static_cast<int>(paths.size()) ? paths[chosen] : "";
}

std::vector<std::string> differences(const std::vector<ConfigStatement>& before,
                                     const std::vector<ConfigStatement>& now,
                                     const std::vector<std::string>& sections) {
  const auto chosen = [&](const std::string& key) {
    return std::any_of(sections.begin(), sections.end(),
                       [&](const std::string& section) { return key.starts_with(section); });
  };
  struct Values {
    std::string before = "not stated", now = "not stated";
  };
  std::map<std::string, Values> values;
  for (const ConfigStatement& s : before) {
    if (chosen(s.key)) values[s.key].before = s.value;
  }
  for (const ConfigStatement& s : now) {
    if (chosen(s.key)) values[s.key].now = s.value;
  }
  std::vector<std::string> lines;
  for (const auto& [key, value] : values) {
    if (value.before == value.now) continue;
    lines.push_back(key + " is " + value.before + " in the checkpoint and " + value.now +
                    " in the case");
  }
  return lines;
}

}  // namespace gasgrain::cfd
