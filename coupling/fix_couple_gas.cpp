#include "coupling/fix_couple_gas.h"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <update.h>

#include <cstdio>
#include <cstring>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/checkpoint.hpp"

namespace gasgrain::coupling {

namespace {

Vec3 column(const double* values) {
  return {values[0], values[1], values[2]};
}

struct Arguments {
  std::string case_file, directory;
};

Arguments read_arguments(int count, char** arguments) {
  const std::string usage = std::string("fix ") + arguments[0] + " couple/gas: ";
  Arguments result;
  for (int n = 3; n < count; n += 2) {
    const std::string key = arguments[n];
    if (key != "case" && key != "out") {
      throw UserError(usage + "unknown keyword '" + key + "'; known are: case CASE.toml, out DIR");
    }
    if (n + 1 >= count) throw UserError(usage + "keyword '" + key + "' needs a value");
    (key == "case" ? result.case_file : result.directory) = arguments[n + 1];
  }
  if (result.case_file.empty()) {
    throw UserError(usage +
                    "no case file; write: fix ID group couple/gas case CASE.toml [out DIR]");
  }
  return result;
}

}  // namespace

FixCoupleGas::FixCoupleGas(LAMMPS_NS::LAMMPS* liggghts, int argument_count, char** arguments)
    : Fix(liggghts, argument_count, arguments) {
  const Arguments given = read_arguments(argument_count, arguments);
  check_host(std::string("fix ") + id + " couple/gas: ");
  nevery = 1;
  create_attribute = 1;
  vector_flag = 1;
  size_vector = 10;
  restart_global = 1;
  restart_peratom = 1;
  global_freq = 1;
  extvector = 0;
  host_ = std::make_unique<LiggghtsHost>(lmp, groupbit);
  run_ =
      std::make_unique<CoupledRun>(given.case_file, given.directory, *host_, host_->communicator());
  size_vector += static_cast<int>(run_->monitors().names().size() + run_->probe_values().size());
  if (run_->monitors().wants_labels()) host_->values().keep_labels();
  if (run_->drag_follows_grains()) host_->values().let_drag_follow();
  state_directory_ = run_->directory().empty() ? "." : run_->directory();
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
}

FixCoupleGas::~FixCoupleGas() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
}

void FixCoupleGas::check_host(const std::string& where) const {
  if (std::strcmp(update->unit_style, "si") != 0) {
    throw UserError(where + "units are '" + update->unit_style + "', but must be 'si'");
  }
  if (!atom->radius_flag || !atom->rmass_flag) {
    throw UserError(where + "needs grains with radius and mass; use atom_style granular");
  }
  if (domain->triclinic) throw UserError(where + "needs an orthogonal box, not a triclinic one");
}

int FixCoupleGas::setmask() {
  using namespace LAMMPS_NS::FixConst;
  return PRE_EXCHANGE | POST_FORCE | END_OF_STEP;
}

void FixCoupleGas::setup(int) {
  if (run_->begun()) {
    run_->continue_run();
  } else {
    std::vector<Vec3> forces(host_->records().size(), Vec3::Zero());
    std::vector<double> coefficients(forces.size(), 0.0);
    run_->begin(forces, coefficients);
    host_->hold(forces, coefficients, run_->given_interval());
  }
  run_->set_up(add_held_forces());
}

void FixCoupleGas::setup_pre_exchange() {
  tell_who_leaves(GrainTraffic::Moment::between_steps);
}

void FixCoupleGas::pre_exchange() {
  tell_who_leaves(GrainTraffic::Moment::mid_step);
}

// Grains beyond a side with a fixed boundary are about to be deleted.
void FixCoupleGas::tell_who_leaves(GrainTraffic::Moment moment) {
  if (!run_->begun()) return;
  host_->for_each_grain([&](int i) {
    for (int d = 0; d < 3; ++d) {
      const double x = atom->x[i][d];
      const bool below = domain->boundary[d][0] == 1 && x < domain->boxlo[d];
      const bool above = domain->boundary[d][1] == 1 && x >= domain->boxhi[d];
      if (!below && !above) continue;
      run_->grain_left(host_->passage(i), host_->values().held(i), moment, update->dt);
      return;
    }
  });
}

void FixCoupleGas::post_force(int) {
  held_forces_applied(add_held_forces());
}

plugins::HeldForces FixCoupleGas::held_forces() const {
  return host_->values().forces();
}

void FixCoupleGas::held_forces_applied(const Vec3& sum) {
  run_->force_applied(update->dt, sum);
}

void FixCoupleGas::end_of_step() {
  if (!run_->step_finished()) return;
  std::vector<Vec3> forces(atom->nlocal, Vec3::Zero());
  std::vector<double> coefficients(forces.size(), 0.0);
  run_->exchange(forces, coefficients);
  host_->hold(forces, coefficients, run_->given_interval());
}

void FixCoupleGas::post_run() {
  if (plugins::run_goes_on(*lmp))
    run_->pause();
  else
    run_->finish_run();
}

// Called by all ranks; the first one writes to `file`: the size in bytes, then the name.
void FixCoupleGas::write_restart(FILE* file) {
  const std::string checkpoint = plugins::checkpoint_directory(*lmp);
  const std::string path = (checkpoint.empty() ? state_directory_ : checkpoint) + "/gas." +
                           std::to_string(update->ntimestep) + ".state.h5";
  if (run_->begun()) run_->save(path);
  if (comm->me != 0) return;
  const int size = run_->begun() ? static_cast<int>(path.size()) + 1 : 1;
  std::fwrite(&size, sizeof(int), 1, file);
  std::fwrite(run_->begun() ? path.c_str() : "", 1, size, file);
}

void FixCoupleGas::restart(char* buffer) {
  const std::string path = buffer;
  if (!path.empty()) run_->restore(path);
}

// A grain's values follow their number.
int FixCoupleGas::pack_restart(int i, double* buffer) {
  buffer[0] = maxsize_restart();
  pack_exchange(i, buffer + 1);
  return maxsize_restart();
}

// `nth`: place of this fix among those whose values follow the atom's own, each with its length.
void FixCoupleGas::unpack_restart(int i, int nth) {
  double* values = atom->extra[i];
  for (int n = 0; n < nth; ++n) values += static_cast<int>(*values);
  unpack_exchange(i, values + 1);
}

int FixCoupleGas::size_restart(int) {
  return maxsize_restart();
}

int FixCoupleGas::maxsize_restart() {
  return host_->values().per_grain() + 1;
}

double FixCoupleGas::compute_vector(int index) {
  const SeriesRow& row = run_->latest();
  switch (index) {
    case 0:
      return row.time;
    case 1:
      return row.bed.pressure_drop;
    case 2:
      return row.bed.height;
    case 3:
      return row.weight_over_area;
    case 4:
      return row.exchange.interval;
    case 5:
      return row.audit.momentum_residual;
    case 6:
      return row.exchange.third_law_residual;
    case 7:
      return row.exchange.solid_volume_residual;
    case 8:
      return row.exchange.divergence;
    case 9:
      return double(row.exchange.grains_outside);
    default:
      break;
  }
  const int monitors = static_cast<int>(run_->monitors().names().size());
  if (index - 10 >= monitors) return run_->probe_values()[index - 10 - monitors];
  return row.monitors.empty() ? 0.0 : row.monitors[index - 10];
}

// Returns their sum over this rank's grains, N.
Vec3 FixCoupleGas::add_held_forces() {
  Vec3 sum = Vec3::Zero();
  const plugins::HeldForces held = held_forces();
  host_->for_each_grain([&](int i) {
    const Vec3 on_grain = held.on(i, column(atom->v[i]));
    sum += on_grain;
    for (int d = 0; d < 3; ++d) atom->f[i][d] += on_grain[d];
  });
  return sum;
}

void FixCoupleGas::grow_arrays(int count) {
  host_->values().resize(count);
}

void FixCoupleGas::copy_arrays(int from, int to, int) {
  host_->values().copy(from, to);
}

void FixCoupleGas::set_arrays(int i) {
  host_->values().clear(i);
  if (!run_->begun() || !host_->coupled(i)) return;
  const bool in_step = update->whichflag == 1 && update->setupflag == 0;
  run_->grain_appeared(
      host_->passage(i),
      in_step ? GrainTraffic::Moment::mid_step : GrainTraffic::Moment::between_steps, update->dt);
}

int FixCoupleGas::pack_exchange(int i, double* buffer) {
  host_->values().pack(i, buffer);
  return host_->values().per_grain();
}

int FixCoupleGas::unpack_exchange(int i, double* buffer) {
  host_->values().unpack(i, buffer);
  return host_->values().per_grain();
}

double FixCoupleGas::memory_usage() {
  return host_->values().bytes();
}

}  // namespace gasgrain::coupling
