#include "liggghts_plugins/coarse_grain_report.hpp"

#include <atom.h>
#include <comm.h>
#include <force.h>
#include <lammps.h>
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>
#include <string>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/checkpoint.hpp"
#include "liggghts_plugins/engine/engine_mode.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::LAMMPS;

struct TypeRow {
  double count = 0;
  double smallest_radius = std::numeric_limits<double>::max();  // of the grains, m
  double largest_radius = 0;
};

std::vector<TypeRow> rows_of_types(LAMMPS& lmp) {
  const LAMMPS_NS::Atom& atom = *lmp.atom;
  std::vector<TypeRow> local(atom.ntypes);
  for (int i = 0; i < atom.nlocal; ++i) {
    TypeRow& row = local[atom.type[i] - 1];
    row.count += 1;
    row.smallest_radius = std::min(row.smallest_radius, atom.radius[i]);
    row.largest_radius = std::max(row.largest_radius, atom.radius[i]);
  }
  std::vector<TypeRow> rows = local;
  for (int t = 0; t < atom.ntypes; ++t) {
    MPI_Allreduce(&local[t].count, &rows[t].count, 1, MPI_DOUBLE, MPI_SUM, lmp.world);
    MPI_Allreduce(&local[t].smallest_radius, &rows[t].smallest_radius, 1, MPI_DOUBLE, MPI_MIN,
                  lmp.world);
    MPI_Allreduce(&local[t].largest_radius, &rows[t].largest_radius, 1, MPI_DOUBLE, MPI_MAX,
                  lmp.world);
  }
  return rows;
}

std::string diameter_text(const TypeRow& row, double l) {
  if (row.count == 0) return "-";
  char text[64];
  const double smallest = 2 * row.smallest_radius / l, largest = 2 * row.largest_radius / l;
  if (smallest == largest)
    std::snprintf(text, sizeof text, "%.6g", largest);
  else
    std::snprintf(text, sizeof text, "%.4g..%.4g", smallest, largest);
  return text;
}

std::string table_text(const std::vector<TypeRow>& rows, LAMMPS_NS::Force& force) {
  std::string text = "Coarse graining:\n";
  char line[200];
  std::snprintf(line, sizeof line, "  %4s %9s %20s %20s %12s %18s\n", "type", "l",
                "original diameter", "grain diameter", "grains", "original particles");
  text += line;
  for (int t = 1; t <= static_cast<int>(rows.size()); ++t) {
    const TypeRow& row = rows[t - 1];
    const double l = force.cg(t);
    std::snprintf(line, sizeof line, "  %4d %9.6g %20s %20s %12.0f %18.0f\n", t, l,
                  diameter_text(row, l).c_str(), diameter_text(row, 1.0).c_str(), row.count,
                  row.count * l * l * l);
    text += line;
  }
  return text;
}

void complete_ratios(CoarseGrainReport& report, LAMMPS& lmp) {
  const int types = lmp.atom->ntypes;
  const int given = static_cast<int>(report.ratios.size());
  if (given != 1 && given != types)
    throw UserError("coarsegraining: " + std::to_string(given) + " values of l for " +
                    std::to_string(types) + " atom types; give one for all, or one per type");
  while (static_cast<int>(report.ratios.size()) < types) {
    report.ratios.push_back(report.ratios.front());
    if (report.scales()) lmp.force->setCG(report.ratios.front());
  }
}

}  // namespace

bool CoarseGrainReport::scales() const {
  return std::any_of(ratios.begin(), ratios.end(), [](double l) { return l != 1.0; });
}

CoarseGrainReport& coarse_grain_report(LAMMPS& lmp) {
  static std::map<const LAMMPS*, CoarseGrainReport> reports;
  return reports[&lmp];
}

void check_and_print_coarse_graining(LAMMPS& lmp) {
  CoarseGrainReport& report = coarse_grain_report(lmp);
  if (report.scales() && !lmp.force->cg_active()) report = {};  // forgotten by a `clear`
  if (report.ratios.empty() || !lmp.atom->radius) return;
  complete_ratios(report, lmp);
  if (report.printed) return;
  report.printed = true;
  const std::string text = table_text(rows_of_types(lmp), *lmp.force);
  if (lmp.comm->me != 0) return;
  if (lmp.screen) std::fputs(text.c_str(), lmp.screen);
  if (lmp.logfile) std::fputs(text.c_str(), lmp.logfile);
}

void run_with_report(LAMMPS* lmp, int argument_count, char** arguments) {
  if (lmp->domain) check_and_print_coarse_graining(*lmp);
  install_engine(*lmp);
  run_with_checkpoints(*lmp, argument_count, arguments);
}

}  // namespace gasgrain::plugins
