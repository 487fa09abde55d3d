#include "cfd/probes.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "coupling/files/collective_error.hpp"

namespace gasgrain::cfd {

namespace {

struct Make {
  const Decomposition& blocks;
  std::unique_ptr<Probe> operator()(const PointProbe& p) const {
    return make_point_probe(p, blocks);
  }
  std::unique_ptr<Probe> operator()(const LineProbe& p) const { return make_line_probe(p, blocks); }
  std::unique_ptr<Probe> operator()(const PlaneProbe& p) const {
    return make_plane_probe(p, blocks);
  }
  std::unique_ptr<Probe> operator()(const BoxProbe& p) const { return make_box_probe(p, blocks); }
  std::unique_ptr<Probe> operator()(const BodyProbe& p) const { return make_body_probe(p); }
};

}  // namespace

Probes::Probes(const std::vector<ProbeSettings>& settings, const GasSolver& solver) {
  for (const ProbeSettings& given : settings) {
    std::unique_ptr<Probe> probe = std::visit(Make{solver.decomposition()}, given.place);
    std::vector<std::string> columns = probe->columns();
    const bool is_line = std::holds_alternative<LineProbe>(given.place);
    const std::ptrdiff_t place = is_line ? -1 : static_cast<std::ptrdiff_t>(values_.size());
    if (!is_line) values_.resize(values_.size() + columns.size());
    entries_.push_back({.name = given.name,
                        .probe = std::move(probe),
                        .columns = std::move(columns),
                        .schedule = Schedule(given.interval),
                        .place = place,
                        .file = {}});
  }
}

void Probes::open_files(const GasSolver& solver, const std::string& directory,
                        std::optional<double> continue_from) {
  const Decomposition& blocks = solver.decomposition();
  run_collectively(blocks.communicator(), [&] {
    for (Entry& entry : entries_) {
      if (continue_from) entry.schedule.skip_to(*continue_from);
      if (blocks.rank() != 0) continue;
      std::vector<std::string> columns{"time_s"};
      columns.insert(columns.end(), entry.columns.begin(), entry.columns.end());
      const auto path = std::filesystem::path(directory) / ("probe_" + entry.name + ".csv");
      entry.file.emplace(path.string(), columns, continue_from);
    }
  });
}

void Probes::take(const GasSolver& solver) {
  const MPI_Comm communicator = solver.decomposition().communicator();
  for (Entry& entry : entries_) {
    if (!entry.schedule.due(solver.time())) continue;
    const std::vector<double> values = entry.probe->sample(solver);
    const auto count = static_cast<std::ptrdiff_t>(entry.columns.size());
    if (entry.place >= 0) {
      double* latest = values_.data() + entry.place;
      if (solver.decomposition().rank() == 0) std::copy(values.begin(), values.end(), latest);
      MPI_Bcast(latest, static_cast<int>(count), MPI_DOUBLE, 0, communicator);
    }
    if (!entry.file) continue;
    for (auto from = values.begin(); from != values.end(); from += count) {
      std::vector<double> row{solver.time()};
      row.insert(row.end(), from, from + count);
      entry.file->add(row);
    }
  }
}

void Probes::flush() {
  for (Entry& entry : entries_) {
    if (entry.file) entry.file->flush();
  }
}

}  // namespace gasgrain::cfd
