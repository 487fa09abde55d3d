#include "liggghts_plugins/engine/pair_search.hpp"

#include <atom.h>
#include <domain.h>
#include <error.h>
#include <fix_contact_history.h>
#include <lammps.h>
#include <neigh_list.h>
#include <neighbor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::Atom;
using LAMMPS_NS::Neighbor;
using LAMMPS_NS::NeighList;

using BuildList = void (Neighbor::*)(NeighList*);

struct ListBuilders {
  using Member = BuildList* Neighbor::*;
  friend Member private_member(ListBuilders);
};
struct OrdinaryBuilder {
  using Member = BuildList;
  friend Member private_member(OrdinaryBuilder);
};
struct BuiltLists {
  using Member = int* Neighbor::*;
  friend Member private_member(BuiltLists);
};
struct BuiltListCount {
  using Member = int Neighbor::*;
  friend Member private_member(BuiltListCount);
};
struct BinCount {
  using Member = int Neighbor::*;
  friend Member private_member(BinCount);
};
struct BinOfPoint {
  using Member = int (Neighbor::*)(double*);
  friend Member private_member(BinOfPoint);
};
template struct GrantAccess<ListBuilders, &Neighbor::pair_build>;
template struct GrantAccess<OrdinaryBuilder, &Neighbor::granular_bin_no_newton>;
template struct GrantAccess<BuiltLists, &Neighbor::blist>;
template struct GrantAccess<BuiltListCount, &Neighbor::nblist>;
template struct GrantAccess<BinCount, &Neighbor::mbins>;
template struct GrantAccess<BinOfPoint, &Neighbor::coord2bin>;

namespace {

// Of distances, relative to the largest coordinate, and of the test itself.
constexpr double rounding = 4.0 * std::numeric_limits<float>::epsilon();

BuildList builder_of(Neighbor& neighbor, int list) {
  return (neighbor.*private_member(ListBuilders()))[list];
}

bool is_ordinary(Neighbor& neighbor, const NeighList& list) {
  return builder_of(neighbor, list.index) == private_member(OrdinaryBuilder()) &&
         !neighbor.exclude_setting() && !neighbor.includegroup;
}

// Rows of the list and of its histories, as LIGGGHTS writes them.
class ListWriter {
 public:
  ListWriter(LAMMPS_NS::LAMMPS& lmp, NeighList& pairs)
      : lmp_(lmp), pairs_(pairs), fix_(pairs.fix_history), values_(pairs.listgranhistory) {
    pairs_.ipage->reset();
    if (!fix_) return;
    values_->ipage->reset();
    values_->dpage->reset();
  }

  void begin_row() {
    count_ = 0;
    partners_ = checked(pairs_.ipage->vget());
    if (!fix_) return;
    flags_ = checked(values_->ipage->vget());
    histories_ = checked(values_->dpage->vget());
  }

  void add(int i, int j, bool touching) {
    if (count_ == pairs_.oneatom) overflow();
    partners_[count_] = j;
    if (fix_) add_history(i, j, touching);
    ++count_;
  }

  void end_row(int i) {
    pairs_.ilist[i] = i;
    pairs_.firstneigh[i] = partners_;
    pairs_.numneigh[i] = count_;
    pairs_.ipage->vgot(count_);
    if (!fix_) return;
    values_->firstneigh[i] = flags_;
    values_->firstdouble[i] = histories_;
    values_->ipage->vgot(count_);
    values_->dpage->vgot(count_ * values_->dnum);
  }

 private:
  void add_history(int i, int j, bool touching) {
    const int length = values_->dnum;
    double* history = histories_ + static_cast<std::ptrdiff_t>(count_) * length;
    flags_[count_] = 0;
    if (touching) {
      for (int m = 0; m < fix_->n_partner(i); ++m) {
        if (fix_->partner(i, m) != lmp_.atom->tag[j]) continue;
        flags_[count_] = 1;
        std::copy_n(fix_->contacthistory(i, m), length, history);
        return;
      }
    }
    std::fill_n(history, length, 0.0);
  }

  template <class Value>
  Value* checked(Value* page) {
    if (!page) overflow();
    return page;
  }
  void overflow() { lmp_.error->one(FLERR, "Neighbor list overflow, boost neigh_modify one"); }

  LAMMPS_NS::LAMMPS& lmp_;
  NeighList& pairs_;
  LAMMPS_NS::FixContactHistory* fix_;
  NeighList* values_;
  int count_ = 0;
  int* partners_ = nullptr;
  int* flags_ = nullptr;
  double* histories_ = nullptr;
};

}  // namespace

void PairSearch::build_lists(LAMMPS_NS::LAMMPS& lmp, NeighList& pairs) {
  Neighbor& neighbor = *lmp.neighbor;
  if (!is_ordinary(neighbor, pairs)) {
    neighbor.build();
    return;
  }
  int& count = neighbor.*private_member(BuiltListCount());
  const int lists = count;
  count = 0;  // LIGGGHTS notes the build and makes room
  neighbor.build();
  count = lists;
  for (int n = 0; n < lists; ++n) {
    const int list = (neighbor.*private_member(BuiltLists()))[n];
    if (neighbor.lists[list] == &pairs)
      build(lmp, pairs);
    else
      (neighbor.*builder_of(neighbor, list))(neighbor.lists[list]);
  }
}

// By counting; grains of a bin stay in the order of their indices.
void PairSearch::sort_into_bins(LAMMPS_NS::LAMMPS& lmp) {
  const Atom& atom = *lmp.atom;
  Neighbor& neighbor = *lmp.neighbor;
  const int total = atom.nlocal + atom.nghost;
  const double factor = neighbor.contactDistanceFactor;
  bin_of_.resize(total);
  bin_begin_.assign(neighbor.*private_member(BinCount()) + 1, 0);
  double farthest = 0.0;
  std::copy_n(lmp.domain->sublo, 3, corner_);
  for (int i = 0; i < total; ++i) {
    bin_of_[i] = (neighbor.*private_member(BinOfPoint()))(atom.x[i]);
    ++bin_begin_[bin_of_[i]];
    for (int d = 0; d < 3; ++d) farthest = std::max(farthest, std::abs(atom.x[i][d] - corner_[d]));
  }
  int begin = 0;
  for (int& entry : bin_begin_) begin += std::exchange(entry, begin);
  const std::size_t room = total + group_size;
  for (std::vector<float>* column : {&x_, &y_, &z_, &reach_}) column->resize(room);
  index_.resize(room);
  margin_ = 0.5 * (neighbor.skin + rounding * farthest);
  for (int i = 0; i < total; ++i) {
    const int place = bin_begin_[bin_of_[i]]++;
    x_[place] = static_cast<float>(atom.x[i][0] - corner_[0]);
    y_[place] = static_cast<float>(atom.x[i][1] - corner_[1]);
    z_[place] = static_cast<float>(atom.x[i][2] - corner_[2]);
    reach_[place] = reach_of(factor * atom.radius[i]);
    index_[place] = i;
  }
  // every entry has moved on to the end of its bin
  std::rotate(bin_begin_.begin(), bin_begin_.end() - 1, bin_begin_.end());
  bin_begin_.front() = 0;
}

float PairSearch::reach_of(double radius) const {
  return static_cast<float>((radius + margin_) * (1.0 + rounding));
}

void PairSearch::find_runs(const NeighList& pairs) {
  runs_.clear();
  for (int k = 0; k < pairs.nstencil; ++k) {
    const int offset = pairs.stencil[k];
    if (!runs_.empty() && runs_.back().last + 1 == offset)
      runs_.back().last = offset;
    else
      runs_.push_back({offset, offset});
  }
  begin_.resize(runs_.size());
  end_.resize(runs_.size());
}

int PairSearch::partners_of(int i, const SearchedGrain& grain) {
  std::size_t most = group_size;
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    begin_[r] = bin_begin_[bin_of_[i] + runs_[r].first];
    end_[r] = bin_begin_[bin_of_[i] + runs_[r].last + 1];
    most += end_[r] - begin_[r];
  }
  if (places_.size() < most) places_.resize(most);
  const SearchRuns runs{begin_.data(), end_.data(), static_cast<int>(runs_.size())};
  return contact_kernel().partners(columns(), runs, grain, places_.data());
}

void PairSearch::build(LAMMPS_NS::LAMMPS& lmp, NeighList& pairs) {
  const Atom& atom = *lmp.atom;
  const Neighbor& neighbor = *lmp.neighbor;
  sort_into_bins(lmp);
  find_runs(pairs);
  const double factor = neighbor.contactDistanceFactor, skin = neighbor.skin;
  ListWriter writer(lmp, pairs);
  for (int i = 0; i < atom.nlocal; ++i) {
    const double* x = atom.x[i];
    const int found = partners_of(
        i, {static_cast<float>(x[0] - corner_[0]), static_cast<float>(x[1] - corner_[1]),
            static_cast<float>(x[2] - corner_[2]), reach_of(factor * atom.radius[i]), i});
    writer.begin_row();
    for (int n = 0; n < found; ++n) {
      const int j = index_[places_[n]];
      const double dx = x[0] - atom.x[j][0], dy = x[1] - atom.x[j][1], dz = x[2] - atom.x[j][2];
      const double square = dx * dx + dy * dy + dz * dz;
      const double radii = (atom.radius[i] + atom.radius[j]) * factor;
      if (square <= (radii + skin) * (radii + skin)) writer.add(i, j, square < radii * radii);
    }
    writer.end_row(i);
  }
  pairs.inum = atom.nlocal;
}

}  // namespace gasgrain::plugins
