#include "coupling/fix_couple_gas.h"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <fix_gravity.h>
#include <force.h>
#include <modify.h>
#include <update.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/checkpoint.hpp"
#include "liggghts_plugins/grain_wall.hpp"
#include "liggghts_plugins/pair_gran_cgm.hpp"

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
  MPI_Comm_dup(world, &communicator_);
  DemHost& host = *this;
  run_ = std::make_unique<CoupledRun>(given.case_file, given.directory, host, communicator_);
  size_vector += static_cast<int>(run_->monitors().names().size());
  if (run_->monitors().wants_labels()) ++values_per_grain_;
  if (run_->drag_follows_grains()) values_per_grain_ += 7;
  state_directory_ = run_->directory().empty() ? "." : run_->directory();
  grow_arrays(atom->nmax);
  atom->add_callback(0);
  atom->add_callback(1);
}

FixCoupleGas::~FixCoupleGas() {
  atom->delete_callback(id, 0);
  atom->delete_callback(id, 1);
  run_.reset();
  MPI_Comm_free(&communicator_);
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
    std::vector<Vec3> forces(records().size(), Vec3::Zero());
    std::vector<double> coefficients(forces.size(), 0.0);
    run_->begin(forces, coefficients);
    hold(forces, coefficients);
  }
  run_->set_up(add_held_forces());
}

void FixCoupleGas::setup_pre_exchange() {
  tell_who_leaves(GrainTraffic::Moment::between_steps);
}

void FixCoupleGas::pre_exchange() {
  tell_who_leaves(GrainTraffic::Moment::mid_step);
}

GrainPassage FixCoupleGas::passage(int i) const {
  const Vec3 velocity = column(atom->v[i]);
  const double spin = atom->radius[i] * column(atom->omega[i]).norm();
  return {.mass = atom->rmass[i],
          .position = column(atom->x[i]),
          .velocity = velocity,
          .energy = 0.5 * atom->rmass[i] * (velocity.squaredNorm() + 0.4 * spin * spin),
          .time = 0.0};
}

// Grains beyond a side with a fixed boundary are about to be deleted.
void FixCoupleGas::tell_who_leaves(GrainTraffic::Moment moment) {
  if (!run_->begun()) return;
  for_each_grain([&](int i) {
    for (int d = 0; d < 3; ++d) {
      const double x = atom->x[i][d];
      const bool below = domain->boundary[d][0] == 1 && x < domain->boxlo[d];
      const bool above = domain->boundary[d][1] == 1 && x >= domain->boxhi[d];
      if (!below && !above) continue;
      run_->grain_left(passage(i), held_[i], moment, update->dt);
      return;
    }
  });
}

void FixCoupleGas::post_force(int) {
  held_forces_applied(add_held_forces());
}

plugins::HeldForces FixCoupleGas::held_forces() const {
  return {held_.data(), coefficients_.empty() ? nullptr : coefficients_.data()};
}

void FixCoupleGas::held_forces_applied(const Vec3& sum) {
  run_->force_applied(update->dt, sum);
}

void FixCoupleGas::end_of_step() {
  if (!run_->step_finished()) return;
  std::vector<Vec3> forces(atom->nlocal, Vec3::Zero());
  std::vector<double> coefficients(forces.size(), 0.0);
  run_->exchange(forces, coefficients);
  hold(forces, coefficients);
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
  return values_per_grain_ + 1;
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
      return row.momentum_residual;
    case 6:
      return row.exchange.third_law_residual;
    case 7:
      return row.exchange.solid_volume_residual;
    case 8:
      return row.exchange.divergence;
    case 9:
      return double(row.exchange.grains_outside);
    default:
      return row.monitors.empty() ? 0.0 : row.monitors[index - 10];
  }
}

template <class Visit>
void FixCoupleGas::for_each_grain(Visit&& visit) const {
  for (int i = 0; i < atom->nlocal; ++i) {
    if (atom->mask[i] & groupbit) visit(i);
  }
}

void FixCoupleGas::hold(const std::vector<Vec3>& forces, const std::vector<double>& coefficients) {
  std::fill(held_.begin(), held_.end(), Vec3::Zero());
  std::size_t n = 0;
  for_each_grain([&](int i) {
    held_[i] = forces[n];
    if (!coefficients_.empty()) {
      coefficients_[i] = coefficients[n];
      given_[i] = run_->given_interval() * forces[n];
      positions_[i] = column(atom->x[i]);
      held_[i] += coefficients[n] * column(atom->v[i]);
    }
    ++n;
  });
}

// Returns their sum over this rank's grains, N.
Vec3 FixCoupleGas::add_held_forces() {
  Vec3 sum = Vec3::Zero();
  const plugins::HeldForces held = held_forces();
  for_each_grain([&](int i) {
    const Vec3 on_grain = held.on(i, column(atom->v[i]));
    sum += on_grain;
    for (int d = 0; d < 3; ++d) atom->f[i][d] += on_grain[d];
  });
  return sum;
}

// The forces of the steps of an interval, computed with the velocities by which the grains moved,
// add up to held T - B (x - x0). Nothing is carried after the first exchange, when the gas had
// given nothing.
void FixCoupleGas::add_carried(std::vector<GrainRecord>& grains, double elapsed,
                               double given) const {
  if (given <= 0) return;
  std::size_t n = 0;
  for_each_grain([&](int i) {
    Vec3& carried = grains[n++].carried;
    if (coefficients_.empty()) {
      carried = (elapsed - given) * held_[i];
    } else if (coefficients_[i] > 0) {
      Vec3 path = column(atom->x[i]) - positions_[i];
      domain->minimum_image(path[0], path[1], path[2]);
      carried = elapsed * held_[i] - coefficients_[i] * path - given_[i];
    }
  });
}

GasForce FixCoupleGas::gas_force(int local_index) const {
  if (coefficients_.empty()) return {.held = held_[local_index]};
  const double b = coefficients_[local_index];
  return {.held = b > 0 ? Vec3(Vec3::Zero()) : held_[local_index],
          .coefficient = b,
          .reference_velocity = b > 0 ? Vec3(held_[local_index] / b) : Vec3(Vec3::Zero())};
}

void FixCoupleGas::grow_arrays(int count) {
  held_.resize(count, Vec3::Zero());
  if (run_->monitors().wants_labels()) labels_.resize(count, 0.0);
  if (!run_->drag_follows_grains()) return;
  coefficients_.resize(count, 0.0);
  given_.resize(count, Vec3::Zero());
  positions_.resize(count, Vec3::Zero());
}

// visit(value) for all that moves with atom i.
template <class Visit>
void FixCoupleGas::for_each_value(int i, Visit&& visit) {
  for (int d = 0; d < 3; ++d) visit(held_[i][d]);
  if (!labels_.empty()) visit(labels_[i]);
  if (coefficients_.empty()) return;
  visit(coefficients_[i]);
  for (int d = 0; d < 3; ++d) visit(given_[i][d]);
  for (int d = 0; d < 3; ++d) visit(positions_[i][d]);
}

void FixCoupleGas::copy_arrays(int from, int to, int) {
  std::array<double, 11> values;  // force, label, drag
  pack_exchange(from, values.data());
  unpack_exchange(to, values.data());
}

void FixCoupleGas::set_arrays(int i) {
  for_each_value(i, [](double& value) { value = 0.0; });
  if (!run_->begun() || !(atom->mask[i] & groupbit)) return;
  const bool in_step = update->whichflag == 1 && update->setupflag == 0;
  run_->grain_appeared(
      passage(i), in_step ? GrainTraffic::Moment::mid_step : GrainTraffic::Moment::between_steps,
      update->dt);
}

int FixCoupleGas::pack_exchange(int i, double* buffer) {
  for_each_value(i, [&](double& value) { *buffer++ = value; });
  return values_per_grain_;
}

int FixCoupleGas::unpack_exchange(int i, double* buffer) {
  for_each_value(i, [&](double& value) { value = *buffer++; });
  return values_per_grain_;
}

double FixCoupleGas::memory_usage() {
  return double(held_.size()) * values_per_grain_ * sizeof(double);
}

double FixCoupleGas::time() const {
  return update->get_cur_time();
}

double FixCoupleGas::step() const {
  return update->dt;
}

Vec3 FixCoupleGas::gravity() const {
  Vec3 sum = Vec3::Zero();
  for (int n = 0; n < modify->nfix; ++n) {
    if (!modify->fix[n] || std::strcmp(modify->fix[n]->style, "gravity") != 0) continue;
    double acceleration[3];
    static_cast<LAMMPS_NS::FixGravity*>(modify->fix[n])->get_gravity(acceleration);
    sum += column(acceleration);
  }
  return sum;
}

RunProgress FixCoupleGas::progress() const {
  return {.done = static_cast<long>(update->ntimestep - update->beginstep),
          .total = static_cast<long>(update->endstep - update->beginstep)};
}

std::vector<std::string> FixCoupleGas::unmeasured_walls() const {
  std::vector<std::string> result;
  const std::vector<plugins::GrainWall*> measured = plugins::grain_walls(*lmp);
  for (int n = 0; n < modify->nfix; ++n) {
    const Fix* fix = modify->fix[n];
    if (!fix || std::strncmp(fix->style, "wall/", 5) != 0) continue;
    const bool known = std::any_of(measured.begin(), measured.end(),
                                   [&](const auto* wall) { return wall->wall_name() == fix->id; });
    if (!known) result.push_back(fix->id);
  }
  return result;
}

std::vector<GrainRecord> FixCoupleGas::records() const {
  std::vector<GrainRecord> result;
  result.reserve(atom->nlocal);
  for_each_grain([&](int i) {
    const double radius = atom->radius[i];
    result.push_back({.position = column(atom->x[i]),
                      .velocity = column(atom->v[i]),
                      .volume = 4.0 / 3.0 * M_PI * radius * radius * radius,
                      .mass = atom->rmass[i],
                      .original_diameter = 2.0 * radius / force->cg(atom->type[i])});
  });
  return result;
}

GrainState FixCoupleGas::grain_state() const {
  GrainState state;
  for_each_grain([&](int i) {
    for (int d = 0; d < 3; ++d) {
      state.positions.push_back(atom->x[i][d]);
      state.velocities.push_back(atom->v[i][d]);
    }
    state.radii.push_back(atom->radius[i]);
    state.types.push_back(atom->type[i]);
    state.ids.push_back(atom->tag[i]);
  });
  return state;
}

void FixCoupleGas::set_labels(const std::vector<double>& labels) {
  std::size_t n = 0;
  for_each_grain([&](int i) { labels_[i] = labels[n++]; });
}

std::vector<double> FixCoupleGas::labels() const {
  std::vector<double> result;
  for_each_grain([&](int i) { result.push_back(labels_[i]); });
  return result;
}

double FixCoupleGas::gas_power() const {
  double power = 0.0;
  const plugins::HeldForces held = held_forces();
  for_each_grain([&](int i) {
    const Vec3 velocity = column(atom->v[i]);
    power += held.on(i, velocity).dot(velocity);
  });
  return power;
}

GrainTotals FixCoupleGas::totals() const {
  GrainTotals mine;
  for_each_grain([&](int i) {
    const GrainPassage grain = passage(i);
    const double translation = 0.5 * grain.mass * grain.velocity.squaredNorm();
    ++mine.count;
    mine.mass += grain.mass;
    mine.momentum += grain.mass * grain.velocity;
    mine.mass_moment += grain.mass * grain.position;
    mine.kinetic_energy += translation;
    mine.rotation_energy += grain.energy - translation;
  });
  if (const plugins::PairGranCgm* pair = plugins::pair_gran_cgm(*lmp))
    mine.elastic_energy = pair->spring_energy();
  const Vec3 &p = mine.momentum, &m = mine.mass_moment;
  double sums[] = {double(mine.count),
                   mine.mass,
                   p[0],
                   p[1],
                   p[2],
                   m[0],
                   m[1],
                   m[2],
                   mine.kinetic_energy,
                   mine.rotation_energy,
                   mine.elastic_energy};
  MPI_Allreduce(MPI_IN_PLACE, sums, 11, MPI_DOUBLE, MPI_SUM, communicator_);
  return {.count = std::lround(sums[0]),
          .mass = sums[1],
          .momentum = column(sums + 2),
          .mass_moment = column(sums + 5),
          .kinetic_energy = sums[8],
          .rotation_energy = sums[9],
          .elastic_energy = sums[10]};
}

GrainSizes FixCoupleGas::sizes() const {
  const double none = -std::numeric_limits<double>::infinity();
  double largest[4] = {none, none, none, none};  // -smallest and largest diameter, the same of d0
  for_each_grain([&](int i) {
    const double diameter = 2.0 * atom->radius[i];
    const double original = diameter / force->cg(atom->type[i]);
    const double values[] = {-diameter, diameter, -original, original};
    for (int n = 0; n < 4; ++n) largest[n] = std::max(largest[n], values[n]);
  });
  MPI_Allreduce(MPI_IN_PLACE, largest, 4, MPI_DOUBLE, MPI_MAX, communicator_);
  if (largest[1] == none) return {};
  return {-largest[0], largest[1], -largest[2], largest[3]};
}

Vec3 FixCoupleGas::take_wall_impulse() {
  Vec3 sum = Vec3::Zero();
  for (plugins::GrainWall* wall : plugins::grain_walls(*lmp)) sum -= wall->take_impulse();
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_DOUBLE, MPI_SUM, communicator_);
  return sum;
}

bool FixCoupleGas::walls_move() const {
  int some = 0;
  for (const plugins::GrainWall* wall : plugins::grain_walls(*lmp)) some |= wall->surface_moves();
  MPI_Allreduce(MPI_IN_PLACE, &some, 1, MPI_INT, MPI_MAX, communicator_);
  return some != 0;
}

plugins::LargestOverlap FixCoupleGas::take_largest_overlap() {
  const plugins::LargestOverlap mine = plugins::contact_statistics().take();
  double largest[2] = {mine.length, mine.relative};
  MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPI_DOUBLE, MPI_MAX, communicator_);
  return {.length = largest[0], .relative = largest[1]};
}

// To the terminal even when LIGGGHTS's own output goes elsewhere (-screen), and to the log file.
void FixCoupleGas::print(const std::string& text) {
  if (comm->me != 0) return;
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
  if (logfile) std::fputs(text.c_str(), logfile);
}

}  // namespace gasgrain::coupling
