#include "cfd/probes.hpp"

#include <filesystem>

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

Probes::Probes(const std::vector<ProbeSettings>& settings, const std::string& directory,
               const GasSolver& solver, std::optional<double> continue_from) {
  const Decomposition& blocks = solver.decomposition();
  for (const ProbeSettings& given : settings) {
    entries_.push_back({std::visit(Make{blocks}, given.place), 0, Schedule(given.interval), {}});
    if (continue_from) entries_.back().schedule.skip_to(*continue_from);
  }
  run_collectively(blocks.communicator(), [&] {
    for (std::size_t n = 0; n < entries_.size(); ++n) {
      std::vector<std::string> columns{"time_s"};
      for (const std::string& name : entries_[n].probe->columns()) columns.push_back(name);
      entries_[n].columns = columns.size() - 1;
      if (blocks.rank() != 0) continue;
      const auto path = std::filesystem::path(directory) / ("probe_" + settings[n].name + ".csv");
      entries_[n].file.emplace(path.string(), columns, continue_from);
    }
  });
}

void Probes::write(const GasSolver& solver) {
  for (Entry& entry : entries_) {
    if (!entry.schedule.due(solver.time())) continue;
    const std::vector<double> values = entry.probe->sample(solver);
    if (!entry.file) continue;
    for (std::size_t at = 0; at < values.size(); at += entry.columns) {
      std::vector<double> row{solver.time()};
      const auto from = values.begin() + static_cast<std::ptrdiff_t>(at);
      row.insert(row.end(), from, from + static_cast<std::ptrdiff_t>(entry.columns));
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
