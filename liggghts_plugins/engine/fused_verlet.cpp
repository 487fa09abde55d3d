#include "liggghts_plugins/engine/fused_verlet.hpp"

#include <atom.h>
#include <comm.h>
#include <compute.h>
#include <domain.h>
#include <fix.h>
#include <force.h>
#include <modify.h>
#include <mpi.h>
#include <neighbor.h>
#include <output.h>
#include <signal_handling.h>
#include <timer.h>
#include <update.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/engine/engine_mode.hpp"
#include "liggghts_plugins/engine/primitive_wall_loads.hpp"
#include "liggghts_plugins/engine/wide_bins.hpp"
#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::bigint;
using LAMMPS_NS::Neighbor;

struct MustCheck {
  using Member = int Neighbor::*;
  friend Member private_member(MustCheck);
};
struct NextRestart {
  using Member = bigint LAMMPS_NS::Output::*;
  friend Member private_member(NextRestart);
};
struct PlacesAtBuild {
  using Member = double** Neighbor::*;
  friend Member private_member(PlacesAtBuild);
};
struct FillBins {
  using Member = void (Neighbor::*)();
  friend Member private_member(FillBins);
};
template struct GrantAccess<FillBins, &Neighbor::bin_atoms>;
template struct GrantAccess<PlacesAtBuild, &Neighbor::xhold>;
template struct GrantAccess<MustCheck, &Neighbor::must_check>;
template struct GrantAccess<NextRestart, &LAMMPS_NS::Output::next_restart>;

namespace {

namespace signals = LAMMPS_NS::SignalHandler;
using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

bool any_matches(LAMMPS_NS::Compute* const* computes, int count, bigint step) {
  return std::any_of(computes, computes + count,
                     [&](LAMMPS_NS::Compute* compute) { return compute->matchstep(step) != 0; });
}

}  // namespace

void FusedVerlet::setup() {
  plan();
  print_plan();
  if (engine_settings(*lmp).mode == EngineMode::fused && !plan_.fused())
    throw UserError("gasgrain_engine fused: " + plan_.text());
  std::optional<WideBins> bins;
  if (plan_.fused()) bins.emplace(*lmp);
  Verlet::setup();
  lists_are_fresh_ = true;
}

void FusedVerlet::plan() {
  if (engine_settings(*lmp).mode == EngineMode::off) {
    plan_ = {};
    plan_.obstacles = {"gasgrain_engine off"};
  } else {
    plan_ = plan_scene(*lmp, engine_settings(*lmp).precision);
  }
  planned_ = true;
}

void FusedVerlet::print_plan() const {
  // scripts of stock styles alone print what they print in stock LIGGGHTS
  if (!plan_.concerns_engine() || comm->me != 0) return;
  const std::string line = plan_.text() + "\n";
  if (screen) std::fputs(line.c_str(), screen);
  if (logfile) std::fputs(line.c_str(), logfile);
}

void FusedVerlet::run(int steps) {
  if (!planned_) plan();  // run ... pre no
  planned_ = false;
  if (!plan_.fused()) {
    lists_are_fresh_ = false;
    Verlet::run(steps);
    return;
  }
  if (steps == 0) return;
  last_step_ = update->ntimestep + steps;
  quit_requested_ = stop_ = false;
  closed_ = true;
  load_grains();
  reneighbour_next_ = !lists_are_fresh_;
  lists_are_fresh_ = false;
  while (update->ntimestep < last_step_ && !stop_) {
    if (stock_step_due(update->ntimestep + 1))
      stock_step();
    else
      fused_step();
  }
  store_histories();
}

bool FusedVerlet::stock_step_due(bigint step) const {
  return any_matches(elist_global, nelist_global, step) ||
         any_matches(elist_atom, nelist_atom, step) ||
         any_matches(vlist_global, nvlist_global, step) ||
         any_matches(vlist_atom, nvlist_atom, step);
}

void FusedVerlet::stock_step() {
  store_histories();
  const bigint builds = neighbor->ncalls;
  Verlet::run(1);
  load_grains();
  if (neighbor->ncalls == builds) reneighbour_next_ = true;
  stop_ = largest_of_ranks(signals::request_quit) > 0;
}

void FusedVerlet::fused_step() {
  ++update->ntimestep;
  timer->stamp();
  if (closed_) open_step();
  for (LAMMPS_NS::Fix* fix : plan_.live_mesh_fixes) fix->initial_integrate(vflag);
  if (reneighbouring_due()) {
    reneighbour();
  } else {
    ++neighbor->ago;
    ghosts_.update_ghosts(loop_);
    for (LAMMPS_NS::Fix* fix : plan_.live_mesh_fixes) fix->pre_force(vflag);
    timer->stamp(TIME_COMM);
  }
  const StepEnd end = who_looks_at_the_end();
  force_pass(end);
  for (LAMMPS_NS::Fix* fix : plan_.live_mesh_fixes) fix->final_integrate();
  timer->stamp(TIME_PAIR);
  act_at_the_end(end);
  if (closed_ && quit_requested_) stop_ = true;
  if (update->ntimestep == output->next) write_output();
}

// The first half of Verlet's step for grains whose last step has ended: as fix nve/sphere does it,
// on the atom arrays, which may have been changed since.
void FusedVerlet::open_step() {
  load_state();
  streams_.hold(loop_, update->ntimestep);
  const double half = 0.5 * update->dt * force->ftm2v;
  double fastest = streams_.square_speed();
  for (int i = 0; i < atom->nlocal; ++i) {
    if (loop_.is_fixed(i)) continue;
    GrainRecord& grain = loop_.grain(i);
    SpinRecord& spin = loop_.spin(i);
    Column velocity(grain.velocity);
    velocity += half * grain.inverse_mass * ConstColumn(atom->f[i]);
    Column(spin.velocity) += half * spin.inverse_inertia * ConstColumn(atom->torque[i]);
    Column(grain.position) += update->dt * velocity;
    fastest = std::max(fastest, velocity.squaredNorm());
  }
  streams_.place(loop_, update->ntimestep, update->dt);
  closed_ = false;
  note_drift(fastest);
}

// All grains have moved by at most the largest speed times dt, on whatever rank. Signals reach the
// ranks at different times; what they ask for is done by all ranks in the same step.
void FusedVerlet::note_drift(double square_speed) {
  double largest[3] = {square_speed, signals::request_quit ? 1.0 : 0.0,
                       signals::request_write_restart ? 1.0 : 0.0};
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, largest, 3, MPI_DOUBLE, MPI_MAX, world);
  const double distance = std::sqrt(largest[0]) * update->dt;
  loop_.note_travel(distance);
  moved_ += distance;
  quit_requested_ = largest[1] > 0.0;
  write_restart_requested_ = largest[2] > 0.0;
}

bool FusedVerlet::restart_file_due() {
  if (!quit_requested_ && !write_restart_requested_)
    return output->*private_member(NextRestart()) == update->ntimestep;
  signals::request_quit = quit_requested_;
  signals::request_write_restart = write_restart_requested_;
  return output->restart_requested(update->ntimestep);
}

double FusedVerlet::largest_of_ranks(double value) const {
  if (comm->nprocs > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, world);
  return value;
}

const double* FusedVerlet::built_at(int i) const {
  return built_at_.empty() ? (neighbor->*private_member(PlacesAtBuild()))[i] : built_at_[i].data();
}

double FusedVerlet::displacement_since_build() const {
  double largest = 0.0;
  for (int i = 0; i < loop_.counts().local; ++i) {
    const ConstColumn position(loop_.grain(i).position);
    largest = std::max(largest, (position - ConstColumn(built_at(i))).squaredNorm());
  }
  return largest_of_ranks(std::sqrt(largest));
}

// As Neighbor::decide(), but by a bound on the displacement, which is made exact when it is used
// up; the lists hold pairs nearer than the skin, so that each grain may move by half of it.
bool FusedVerlet::reneighbouring_due() {
  if (neighbor->*private_member(MustCheck())) {
    if (restart_file_due()) return true;
    for (const LAMMPS_NS::Fix* fix : plan_.reneighbouring)
      if (fix->next_reneighbor == update->ntimestep) return true;
  }
  if (reneighbour_next_) return true;
  const double allowed = 0.5 * neighbor->skin;
  if (moved_ <= allowed) return false;
  moved_ = displacement_since_build();
  constexpr double nearly_all = 0.95;  // the exact value is not worth asking for again
  return moved_ > nearly_all * allowed;
}

// The middle of Verlet::run(). A shrink-wrapped box changes here and nowhere else.
void FusedVerlet::reneighbour() {
  store_state(0);
  store_histories();
  if (modify->n_pre_exchange) modify->pre_exchange();
  domain->pbc();
  std::optional<WideBins> bins;
  if (domain->box_change) {
    bins.emplace(*lmp);
    domain->reset_box();
    comm->setup();
    neighbor->setup_bins();
  }
  timer->stamp();
  comm->exchange();
  if (atom->sortfreq > 0 && update->ntimestep >= atom->nextsort) atom->sort();
  comm->borders();
  timer->stamp(TIME_COMM);
  if (modify->n_pre_neighbor) modify->pre_neighbor();
  search_.build_lists(*lmp, pair_list());
  // LIGGGHTS's bins, of which our search has no need, are where meshes look for grains
  if (plan_.mesh_wall) (neighbor->*private_member(FillBins()))();
  for (LAMMPS_NS::Fix* fix : plan_.mesh_fixes) fix->pre_force(vflag);
  load_grains();
  timer->stamp(TIME_NEIGHBOR);
}

FusedVerlet::StepEnd FusedVerlet::who_looks_at_the_end() const {
  const bigint step = update->ntimestep;
  if (step == last_step_ || quit_requested_ || stock_step_due(step + 1)) return StepEnd::closed;
  StepEnd end = step == output->next ? StepEnd::shown : StepEnd::passed;
  for (int n = 0; n < modify->nfix; ++n) {
    if (!(modify->fmask[n] & LAMMPS_NS::FixConst::END_OF_STEP)) continue;
    const LAMMPS_NS::Fix* fix = modify->fix[n];
    if (step % fix->nevery != 0 || is_stream(fix)) continue;
    if (fix != plan_.held_force_fix) return StepEnd::closed;
    if (plan_.held_force->end_of_step_uses_atoms()) end = StepEnd::shown;
  }
  return end;
}

void FusedVerlet::compute_outside_loads() {
  std::vector<std::vector<GrainLoad>>& loads = loop_.outside_loads();
  loads.resize(plan_.primitive_walls.size() + mesh_loads_.size());
  std::size_t n = 0;
  for (LAMMPS_NS::FixWallGran* wall : plan_.primitive_walls)
    compute_wall_loads(loads[n++], *wall, *atom, loop_);
  for (MeshWallLoads& mesh : mesh_loads_) mesh.compute(loads[n++], loop_, loop_.travelled());
}

void FusedVerlet::force_pass(StepEnd end) {
  const bool goes_on = end != StepEnd::closed;
  const double half_kick = 0.5 * update->dt * force->ftm2v;
  const HeldForces held = plan_.held_force ? plan_.held_force->held_forces() : HeldForces{};
  const PassSettings settings{.slip = {History::advance, update->dt},
                              .kick = goes_on ? 2.0 * half_kick : half_kick,
                              .drift = goes_on ? update->dt : 0.0,
                              .gravity = plan_.acceleration,
                              .held = held};
  compute_outside_loads();
  const GrainLoop::Observer show = [&](int i, const LoadRecord& load) {
    show_grain(i, load, held, half_kick);
  };
  loop_.force_pass(settings, end != StepEnd::passed ? &show : nullptr);
  histories_are_ours_ = true;
  closed_ = !goes_on;
  contact_statistics().note(loop_.largest_overlap());
  if (plan_.held_force) plan_.held_force->held_forces_applied(loop_.held_force_sum());
  if (end != StepEnd::passed) {
    store_state(atom->nlocal);  // ghosts
    for (LAMMPS_NS::Fix* fix : plan_.after_contacts) fix->post_force(vflag);
  }
  if (!goes_on) return;
  const double fastest = std::max(loop_.square_speed(), streams_.square_speed());
  streams_.place(loop_, update->ntimestep + 1, update->dt);
  note_drift(fastest);
}

bool FusedVerlet::is_stream(const LAMMPS_NS::Fix* fix) const {
  return std::find(plan_.streams.begin(), plan_.streams.end(), fix) != plan_.streams.end();
}

// As Modify::end_of_step(). What fix insert/stream does there is done in our records already.
void FusedVerlet::act_at_the_end(StepEnd end) {
  for (int n = 0; n < modify->nfix; ++n) {
    LAMMPS_NS::Fix* fix = modify->fix[n];
    if (!(modify->fmask[n] & LAMMPS_NS::FixConst::END_OF_STEP)) continue;
    if (update->ntimestep % fix->nevery != 0) continue;
    if (end != StepEnd::passed || !is_stream(fix)) fix->end_of_step();
  }
}

void FusedVerlet::write_output() {
  timer->stamp();
  store_histories();
  output->write(update->ntimestep);
  timer->stamp(TIME_OUTPUT);
}

}  // namespace gasgrain::plugins
