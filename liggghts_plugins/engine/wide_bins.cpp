#include "liggghts_plugins/engine/wide_bins.hpp"

#include <atom.h>
#include <lammps.h>
#include <neighbor.h>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

using LAMMPS_NS::Atom;
using LAMMPS_NS::Neighbor;

struct SearchBinIsChosen {
  using Member = int Neighbor::*;
  friend Member private_member(SearchBinIsChosen);
};
struct SearchBin {
  using Member = double Neighbor::*;
  friend Member private_member(SearchBin);
};
struct SortingBin {
  using Member = double Atom::*;
  friend Member private_member(SortingBin);
};
template struct GrantAccess<SearchBinIsChosen, &Neighbor::binsizeflag>;
template struct GrantAccess<SearchBin, &Neighbor::binsize_user>;
template struct GrantAccess<SortingBin, &Atom::userbinsize>;

namespace {

int& search_bin_is_chosen(LAMMPS_NS::LAMMPS& lmp) {
  return lmp.neighbor->*private_member(SearchBinIsChosen());
}
double& sorting_bin(LAMMPS_NS::LAMMPS& lmp) {
  return lmp.atom->*private_member(SortingBin());
}

}  // namespace

WideBins::WideBins(LAMMPS_NS::LAMMPS& lmp)
    : lmp_(lmp), search_(search_bin_is_chosen(lmp) == 0), sorting_(sorting_bin(lmp) == 0.0) {
  const double width = lmp.neighbor->cutneighmax;
  if (search_) {
    search_bin_is_chosen(lmp) = 1;
    lmp.neighbor->*private_member(SearchBin()) = width;
  }
  if (sorting_) sorting_bin(lmp) = width;
}

WideBins::~WideBins() {
  if (search_) search_bin_is_chosen(lmp_) = 0;
  if (sorting_) sorting_bin(lmp_) = 0.0;
}

}  // namespace gasgrain::plugins
