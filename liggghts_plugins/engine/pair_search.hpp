// LIGGGHTS's list of pairs of grains, built in vectors.
//
// The pairs, their order and the histories that come with them are those of LIGGGHTS's own build
// (granular pairs, half lists, newton off): everybody who reads the list finds the same. Its search
// follows linked lists through 27 bins; ours sorts the grains by bin once and tests eight of a row
// of bins at a time.
//
// Scheme: positions in single precision, from the corner of this rank's part of the box, find all
// pairs nearer than the skin and a margin for rounding; their distance is taken again in double, as
// LIGGGHTS takes it.
#pragma once

#include <vector>

#include "liggghts_plugins/engine/kernel.hpp"

namespace LAMMPS_NS {
class LAMMPS;
class NeighList;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

class PairSearch {
 public:
  // In place of Neighbor::build(): all lists, `pairs` by our search unless the script excludes
  // pairs or builds for a group only.
  void build_lists(LAMMPS_NS::LAMMPS& lmp, LAMMPS_NS::NeighList& pairs);

 private:
  void sort_into_bins(LAMMPS_NS::LAMMPS& lmp);
  void find_runs(const LAMMPS_NS::NeighList& pairs);
  void build(LAMMPS_NS::LAMMPS& lmp, LAMMPS_NS::NeighList& pairs);
  int partners_of(int i, const SearchedGrain& grain);
  float reach_of(double radius) const;
  SearchColumns columns() const {
    return {x_.data(), y_.data(), z_.data(), reach_.data(), index_.data()};
  }

  std::vector<int> bin_of_;     // per grain, ghosts included
  std::vector<int> bin_begin_;  // place of its first grain, per bin, and the end
  std::vector<float> x_, y_, z_, reach_;
  std::vector<int> index_;
  double corner_[3] = {};  // m
  double margin_ = 0;      // m, half the skin and half of what rounding may take away

  // Bins next to each other among those around a bin: offsets of the first and the last.
  struct Run {
    int first, last;
  };
  std::vector<Run> runs_;
  std::vector<int> begin_, end_;  // of one grain's runs
  std::vector<int> places_;
};

}  // namespace gasgrain::plugins
