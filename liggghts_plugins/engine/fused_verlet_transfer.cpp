// Between LIGGGHTS's arrays and the engine's records: grains, pairs, contact histories.
#include <atom.h>
#include <fix_wall_gran.h>
#include <force.h>
#include <lammps.h>
#include <neigh_list.h>
#include <neighbor.h>
#include <pair_gran.h>
#include <update.h>

#include <algorithm>
#include <span>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/engine/fused_verlet.hpp"
#include "liggghts_plugins/engine/primitive_wall_loads.hpp"
#include "liggghts_plugins/fix_wall_sdf.h"
#include "liggghts_plugins/pair_gran_cgm.hpp"

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

// `flags`: the list of contact flags, or nullptr.
PairCounts count_pairs(const LAMMPS_NS::NeighList& list, const LAMMPS_NS::NeighList* flags) {
  PairCounts counts;
  for (int i = 0; i < list.inum; ++i) {
    counts.candidates += list.numneigh[i];
    if (!flags) continue;
    for (const int flag : std::span(flags->firstneigh[i], list.numneigh[i]))
      counts.touching += flag != 0 ? 1 : 0;
  }
  return counts;
}

}  // namespace

LAMMPS_NS::NeighList& FusedVerlet::pair_list() const {
  return *static_cast<const LAMMPS_NS::PairGran&>(*force->pair).list;
}

// Flags and values of the pairs of pair_list(), if tangential springs are among them.
const LAMMPS_NS::NeighList* FusedVerlet::history_list() const {
  return plan_.pair->history_offset() >= 0 ? pair_list().listgranhistory : nullptr;
}

void FusedVerlet::load_grains() {
  const GrainCounts counts{atom->nlocal, atom->nghost};
  loop_.start(counts, *plan_.pair, count_pairs(pair_list(), history_list()), plan_.precision);
  load_state();
  streams_.load(*lmp, plan_.streams.empty() ? nullptr : plan_.streams.front(), update->ntimestep);
  streams_.hold(loop_, update->ntimestep);
  load_pairs();
  loop_.walls().clear();
  for (FixWallSdf* wall : plan_.walls) loop_.walls().emplace_back(*wall);
  loop_.finish_loading(neighbor->skin);
  for (LAMMPS_NS::FixWallGran* wall : plan_.primitive_walls)
    keep_near_grains(*wall, *atom, neighbor->skin);
  mesh_loads_.clear();
  for (int n = 0; plan_.mesh_wall && n < plan_.mesh_wall->n_meshes(); ++n)
    mesh_loads_.emplace_back(*plan_.mesh_wall, n, *atom, *neighbor);
  ghosts_.load(*lmp);
  built_at_.resize(neighbor->dist_check ? 0 : counts.local);
  for (int i = 0; i < static_cast<int>(built_at_.size()); ++i)
    built_at_[i] = ConstColumn(atom->x[i]);
  moved_ = 0.0;
  reneighbour_next_ = false;
  histories_are_ours_ = false;
}

void FusedVerlet::load_state() {
  const int total = atom->nlocal + atom->nghost;
  for (int i = 0; i < total; ++i)
    loop_.set_grain(i, {.position = atom->x[i],
                        .velocity = atom->v[i],
                        .spin = atom->omega[i],
                        .contact = {.type = atom->type[i],
                                    .mass = atom->rmass[i],
                                    .radius = atom->radius[i],
                                    .frozen = (atom->mask[i] & plan_.frozen_group) != 0},
                        .fixed = (atom->mask[i] & plan_.moving_group) == 0});
}

// LIGGGHTS's list holds every pair once, with the smaller index first, and all grains in order.
void FusedVerlet::load_pairs() {
  const LAMMPS_NS::NeighList& list = pair_list();
  const LAMMPS_NS::NeighList* histories = history_list();
  const int offset = plan_.pair->history_offset();
  GASGRAIN_ASSERT(list.inum == atom->nlocal);
  ContactList& pairs = loop_.pairs();
  for (int i = 0; i < list.inum; ++i) {
    GASGRAIN_ASSERT(list.ilist[i] == i);
    const std::span<const int> partners(list.firstneigh[i], list.numneigh[i]);
    for (int n = 0; n < list.numneigh[i]; ++n) {
      // without bonds, the bits that mark bonded partners are not set
      GASGRAIN_ASSERT(partners[n] > i && (partners[n] & NEIGHMASK) == partners[n]);
      if (histories && histories->firstneigh[i][n])
        pairs.add_touching(pairs.next_candidate() + n, histories->firstdouble[i] + 3 * n + offset);
    }
    pairs.add_row(partners);
  }
}

void FusedVerlet::store_state(int from) {
  const int total = loop_.counts().total();
  for (int i = from; i < total; ++i) {
    Column(atom->x[i]) = ConstColumn(loop_.grain(i).position);
    Column(atom->v[i]) = ConstColumn(loop_.grain(i).velocity);
    Column(atom->omega[i]) = ConstColumn(loop_.spin(i).velocity);
  }
}

// The end of the present step, half a kick from the engine's state. Forces without gravity, whose
// fix adds it and sums up its energy.
void FusedVerlet::show_grain(int i, const LoadRecord& load, const HeldForces& held,
                             double half_kick) {
  const GrainRecord& grain = loop_.grain(i);
  const SpinRecord& spin = loop_.spin(i);
  Vec3 f = ConstColumn(load.force);
  if (held.constant) f += held.on(i, ConstColumn(grain.velocity));
  const ConstColumn torque(load.torque);
  Column(atom->f[i]) = f;
  Column(atom->torque[i]) = torque;
  if (loop_.is_fixed(i)) return;
  Column(atom->x[i]) = ConstColumn(grain.position);
  Column(atom->v[i]) =
      ConstColumn(grain.velocity) + half_kick * (grain.inverse_mass * f + plan_.acceleration);
  Column(atom->omega[i]) = ConstColumn(spin.velocity) + half_kick * spin.inverse_inertia * torque;
}

void FusedVerlet::store_histories() {
  if (!histories_are_ours_) return;
  histories_are_ours_ = false;
  // Pair::compute() sets this flag: the list is newer than what fix contacthistory holds
  int dimension = 0;
  *static_cast<int*>(force->pair->extract("computeflag", dimension)) = 1;
  const LAMMPS_NS::NeighList* histories = history_list();
  if (!histories) return;
  const int offset = plan_.pair->history_offset();
  const ContactList& pairs = loop_.pairs();
  for (int i = 0; i < loop_.counts().local; ++i) {
    const int count = pairs.row_end(i) - pairs.row_begin(i);
    std::fill_n(histories->firstneigh[i], count, 0);
    std::fill_n(histories->firstdouble[i], 3 * count, 0.0);
  }
  int i = 0;
  pairs.visit_touching([&](int candidate, const double* spring) {
    while (candidate >= pairs.row_end(i)) ++i;
    const int n = candidate - pairs.row_begin(i);
    histories->firstneigh[i][n] = touching_flags();
    std::copy_n(spring, 3, histories->firstdouble[i] + 3 * n + offset);
  });
}

}  // namespace gasgrain::plugins
