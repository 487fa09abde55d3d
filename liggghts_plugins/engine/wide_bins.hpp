// Bins of the neighbour search and of the sorting in space, as wide as the cutoff.
//
// LIGGGHTS takes half of the cutoff. For grains that is about a fifth of a grain per bin: two
// arrays of the whole box, most of it empty above a bed, which were 40 % of all memory, and 125
// bins to visit per grain. With the full width it is an eighth of the bins, and 27 to visit.
#pragma once

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

// While it lives, bins are set up that wide, unless the script chose a width (neigh_modify binsize,
// atom_modify sort). Bins that exist stay. Lists get another order, so the stock loop does not use
// it: its results are stock's bits.
class WideBins {
 public:
  explicit WideBins(LAMMPS_NS::LAMMPS& lmp);
  ~WideBins();
  WideBins(const WideBins&) = delete;
  WideBins& operator=(const WideBins&) = delete;

 private:
  LAMMPS_NS::LAMMPS& lmp_;
  bool search_, sorting_;  // changed
};

}  // namespace gasgrain::plugins
