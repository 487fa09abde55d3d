#include "coupling/liggghts_host.hpp"

#include <atom.h>
#include <comm.h>
#include <domain.h>
#include <fix_gravity.h>
#include <force.h>
#include <modify.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "liggghts_plugins/grain_wall.hpp"
#include "liggghts_plugins/pair_gran_cgm.hpp"

namespace gasgrain::coupling {

namespace {

Vec3 column(const double* values) {
  return {values[0], values[1], values[2]};
}

}  // namespace

LiggghtsHost::LiggghtsHost(LAMMPS_NS::LAMMPS* liggghts, int group_bit)
    : Pointers(liggghts), group_bit_(group_bit) {
  MPI_Comm_dup(world, &communicator_);
}

LiggghtsHost::~LiggghtsHost() {
  MPI_Comm_free(&communicator_);
}

int LiggghtsHost::count_of_atoms() const {
  return atom->nlocal;
}

bool LiggghtsHost::coupled(int i) const {
  return atom->mask[i] & group_bit_;
}

void LiggghtsHost::hold(const std::vector<Vec3>& forces, const std::vector<double>& coefficients,
                        double interval) {
  values_.release();
  std::size_t n = 0;
  for_each_grain([&](int i) {
    values_.hold(i, {.force = forces[n],
                     .coefficient = coefficients[n],
                     .interval = interval,
                     .position = column(atom->x[i]),
                     .velocity = column(atom->v[i])});
    ++n;
  });
}

double LiggghtsHost::time() const {
  return update->get_cur_time();
}

double LiggghtsHost::step() const {
  return update->dt;
}

Vec3 LiggghtsHost::gravity() const {
  Vec3 sum = Vec3::Zero();
  for (int n = 0; n < modify->nfix; ++n) {
    if (!modify->fix[n] || std::strcmp(modify->fix[n]->style, "gravity") != 0) continue;
    double acceleration[3];
    static_cast<LAMMPS_NS::FixGravity*>(modify->fix[n])->get_gravity(acceleration);
    sum += column(acceleration);
  }
  return sum;
}

RunProgress LiggghtsHost::progress() const {
  return {.done = static_cast<long>(update->ntimestep - update->beginstep),
          .total = static_cast<long>(update->endstep - update->beginstep)};
}

std::vector<std::string> LiggghtsHost::unmeasured_walls() const {
  std::vector<std::string> result;
  const std::vector<plugins::GrainWall*> measured = plugins::grain_walls(*lmp);
  for (int n = 0; n < modify->nfix; ++n) {
    const LAMMPS_NS::Fix* fix = modify->fix[n];
    if (!fix || std::strncmp(fix->style, "wall/", 5) != 0) continue;
    const bool known = std::any_of(measured.begin(), measured.end(),
                                   [&](const auto* wall) { return wall->wall_name() == fix->id; });
    if (!known) result.push_back(fix->id);
  }
  return result;
}

bool LiggghtsHost::walls_move() const {
  int some = 0;
  for (const plugins::GrainWall* wall : plugins::grain_walls(*lmp)) some |= wall->surface_moves();
  MPI_Allreduce(MPI_IN_PLACE, &some, 1, MPI_INT, MPI_MAX, communicator_);
  return some != 0;
}

std::vector<GrainRecord> LiggghtsHost::records() const {
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

void LiggghtsHost::add_carried(std::vector<GrainRecord>& grains, double elapsed,
                               double given) const {
  std::size_t n = 0;
  for_each_grain([&](int i) {
    Vec3 path = Vec3::Zero();
    if (values_.drag_follows()) {
      path = column(atom->x[i]) - values_.position(i);
      domain->minimum_image(path[0], path[1], path[2]);
    }
    grains[n++].carried = values_.received_beyond(i, path, elapsed, given);
  });
}

GrainState LiggghtsHost::grain_state() const {
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

void LiggghtsHost::set_labels(const std::vector<double>& labels) {
  std::size_t n = 0;
  for_each_grain([&](int i) { values_.label(i) = labels[n++]; });
}

std::vector<double> LiggghtsHost::labels() const {
  std::vector<double> result;
  for_each_grain([&](int i) { result.push_back(values_.label(i)); });
  return result;
}

double LiggghtsHost::gas_power() const {
  double power = 0.0;
  const plugins::HeldForces held = values_.forces();
  for_each_grain([&](int i) {
    const Vec3 velocity = column(atom->v[i]);
    power += held.on(i, velocity).dot(velocity);
  });
  return power;
}

GrainPassage LiggghtsHost::passage(int i) const {
  const Vec3 velocity = column(atom->v[i]);
  const double spin = atom->radius[i] * column(atom->omega[i]).norm();
  return {.mass = atom->rmass[i],
          .position = column(atom->x[i]),
          .velocity = velocity,
          .energy = 0.5 * atom->rmass[i] * (velocity.squaredNorm() + 0.4 * spin * spin),
          .time = 0.0};
}

GrainTotals LiggghtsHost::totals() const {
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

GrainSizes LiggghtsHost::sizes() const {
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

Vec3 LiggghtsHost::take_wall_impulse() {
  Vec3 sum = Vec3::Zero();
  for (plugins::GrainWall* wall : plugins::grain_walls(*lmp)) sum -= wall->take_impulse();
  MPI_Allreduce(MPI_IN_PLACE, sum.data(), 3, MPI_DOUBLE, MPI_SUM, communicator_);
  return sum;
}

plugins::LargestOverlap LiggghtsHost::take_largest_overlap() {
  const plugins::LargestOverlap mine = plugins::contact_statistics().take();
  double largest[2] = {mine.length, mine.relative};
  MPI_Allreduce(MPI_IN_PLACE, largest, 2, MPI_DOUBLE, MPI_MAX, communicator_);
  return {.length = largest[0], .relative = largest[1]};
}

// To the terminal even when LIGGGHTS's own output goes elsewhere (-screen), and to the log file.
void LiggghtsHost::print(const std::string& text) {
  if (comm->me != 0) return;
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
  if (logfile) std::fputs(text.c_str(), logfile);
}

}  // namespace gasgrain::coupling
