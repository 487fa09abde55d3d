// `pair_style gran model cgm`: the coarse-grain contact law over LIGGGHTS's neighbour list.
//
// Implements the pair interface of LIGGGHTS directly instead of a stack of model templates: one
// loop over the list, specialized for the tangential model. History is LIGGGHTS's own contact
// history (three components, newton flag 1), cleared as soon as a pair separates.
#pragma once

#include <granular_pair_style.h>
#include <pointers.h>

#include "liggghts_plugins/contact_properties.hpp"
#include "liggghts_plugins/contact_settings.hpp"

namespace gasgrain::plugins {

class PairGranCgm : public LIGGGHTS::PairStyles::IGranularPairStyle, protected LAMMPS_NS::Pointers {
 public:
  PairGranCgm(LAMMPS_NS::LAMMPS* liggghts, LAMMPS_NS::PairGran* parent, int64_t variant);
  ~PairGranCgm() override;

  void settings(int argument_count, char** arguments,
                LIGGGHTS::IContactHistorySetup* history) override;
  void init_granular() override;
  void write_restart_settings(FILE* file) override;
  void read_restart_settings(FILE* file, int64_t variant) override;
  void compute_force(LAMMPS_NS::PairGran* pair, int eflag, int vflag, int addflag) override;
  int get_history_offset(const std::string name) override;
  double stressStrainExponent() override { return 1.0; }
  int64_t hashcode() override { return variant_; }
  bool contact_match(const std::string kind, const std::string model) override;

  // For the fused engine, which computes the contacts itself between reneighbourings.
  const LAMMPS_NS::PairGran* parent() const { return parent_; }
  TangentialModel tangential() const { return settings_.tangential; }
  const GrainContactTable& contacts() const { return contacts_; }
  // Energy of the normal springs less that of adhesion, J; a pair across ranks counts half on each.
  // Positions of ghosts must be the present ones.
  double spring_energy() const;
  // Place of the tangential spring among the history values of a pair; -1: none.
  int history_offset() const { return history_offset_; }

 private:
  template <TangentialModel tangential, class Report>
  void loop(LAMMPS_NS::PairGran& pair, Report report);
  template <class Report>
  void loop_of_tangential_model(LAMMPS_NS::PairGran& pair, Report report);

  LAMMPS_NS::PairGran* parent_;
  int64_t variant_;
  ContactSettings settings_;
  int history_offset_ = -1;
  GrainContactTable contacts_;
};

// Flags that LIGGGHTS's contact history holds for a touching pair of `model cgm`.
int touching_flags();

// The pair style of this LIGGGHTS instance if it is `gran model cgm`, or nullptr.
PairGranCgm* pair_gran_cgm(const LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
