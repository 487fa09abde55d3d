// Between LIGGGHTS's arrays and the engine's records: grains, pairs, contact histories.
#include <atom.h>
#include <force.h>
#include <lammps.h>
#include <neigh_list.h>
#include <neighbor.h>
#include <pair_gran.h>
#include <update.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/engine/fused_verlet.hpp"
#include "liggghts_plugins/engine/primitive_wall_loads.hpp"
#include "liggghts_plugins/fix_wall_sdf.h"
#include "liggghts_plugins/pair_gran_cgm.hpp"

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

std::size_t sum_of(const int* values, int count) {
  return std::accumulate(values, values + count, std::size_t{0});
}

// Of a list of contact flags.
std::size_t touching_count(const LAMMPS_NS::NeighList& list, const LAMMPS_NS::NeighList& flags) {
  std::size_t count = 0;
  for (int i = 0; i < list.inum; ++i)
    count += std::count_if(flags.firstneigh[i], flags.firstneigh[i] + list.numneigh[i],
                           [](int flag) { return flag != 0; });
  return count;
}

}  // namespace

void FusedVerlet::load_grains() {
  const GrainCounts counts{atom->nlocal, atom->nghost};
  const LAMMPS_NS::NeighList& list = *static_cast<const LAMMPS_NS::PairGran&>(*force->pair).list;
  loop_.start(counts, *plan_.pair, sum_of(list.numneigh, list.inum));
  load_state();
  streams_.load(*lmp, plan_.streams.empty() ? nullptr : plan_.streams.front(), update->ntimestep);
  streams_.hold(loop_, update->ntimestep);
  load_pairs();
  loop_.walls().clear();
  for (FixWallSdf* wall : plan_.walls) loop_.walls().emplace_back(*wall);
  loop_.finish_loading(neighbor->skin);
  for (LAMMPS_NS::FixWallGran* wall : plan_.primitive_walls)
    keep_near_grains(*wall, *atom, neighbor->skin);
  ghosts_.load(*lmp);
  built_at_.resize(counts.local);
  for (int i = 0; i < counts.local; ++i) built_at_[i] = ConstColumn(atom->x[i]);
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
  const auto& gran = static_cast<const LAMMPS_NS::PairGran&>(*force->pair);
  const LAMMPS_NS::NeighList& list = *gran.list;
  const int offset = plan_.pair->history_offset();
  const LAMMPS_NS::NeighList* histories = offset >= 0 ? list.listgranhistory : nullptr;
  GASGRAIN_ASSERT(list.inum == atom->nlocal);
  ContactList& pairs = loop_.pairs();
  std::vector<TouchingPair> touching;
  if (histories) touching.reserve(touching_count(list, *histories));
  for (int i = 0; i < list.inum; ++i) {
    GASGRAIN_ASSERT(list.ilist[i] == i);
    for (int n = 0; n < list.numneigh[i]; ++n) {
      const int j = list.firstneigh[i][n] & NEIGHMASK;
      GASGRAIN_ASSERT(j > i);
      pairs.add_candidate(j);
      if (histories && histories->firstneigh[i][n]) {
        const double* spring = histories->firstdouble[i] + 3 * n + offset;
        touching.push_back({pairs.row_begin(i) + n, {spring[0], spring[1], spring[2]}});
      }
    }
    pairs.end_row();
  }
  pairs.set_touching(std::move(touching));
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
void FusedVerlet::show_grain(int i, const LoadRecord& load, const Vec3* held, double half_kick) {
  const GrainRecord& grain = loop_.grain(i);
  const SpinRecord& spin = loop_.spin(i);
  Vec3 f = ConstColumn(load.force);
  if (held) f += held[i];
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
  const int offset = plan_.pair->history_offset();
  if (offset < 0) return;
  const LAMMPS_NS::NeighList& histories =
      *static_cast<const LAMMPS_NS::PairGran&>(*force->pair).list->listgranhistory;
  ContactList& pairs = loop_.pairs();
  const std::vector<TouchingPair>& touching = pairs.touching();
  auto pair = touching.begin();
  for (int i = 0; i < loop_.counts().local; ++i) {
    const int begin = pairs.row_begin(i), count = pairs.row_end(i) - begin;
    std::fill_n(histories.firstneigh[i], count, 0);
    std::fill_n(histories.firstdouble[i], 3 * count, 0.0);
    for (; pair != touching.end() && pair->candidate < begin + count; ++pair) {
      const int n = pair->candidate - begin;
      histories.firstneigh[i][n] = touching_flags();
      std::copy_n(pair->spring, 3, histories.firstdouble[i] + 3 * n + offset);
    }
  }
}

}  // namespace gasgrain::plugins
