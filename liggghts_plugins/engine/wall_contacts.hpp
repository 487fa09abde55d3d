// Contacts of the engine's grains with one SDF wall: the force of fix wall/sdf, on our records.
//
// The distance of a candidate is not asked for again until grain and wall have travelled, together,
// the way that they can go before they may touch.
#pragma once

#include <vector>

#include "coupling/shared/signed_distance.hpp"
#include "liggghts_plugins/contact_properties.hpp"
#include "liggghts_plugins/engine/kernel.hpp"
#include "liggghts_plugins/fix_wall_sdf.h"
#include "liggghts_plugins/sphere_contact.hpp"

namespace gasgrain::plugins {

// The records and what the contact law needs besides, by grain index.
struct WallBatch {
  const GrainRecord* grains;
  const SpinRecord* spins;
  LoadRing ring;
  TangentialStep step;
  double travelled;  // m, at least what any grain has moved since the walls were loaded
};

class WallContacts {
 public:
  explicit WallContacts(FixWallSdf& wall) : wall_(&wall) {}

  // Takes the candidates from the fix, where their springs stay.
  void load(int local_count);

  void begin_step();
  void add_contact_loads(int block, const WallBatch& batch);
  // Tells the fix the load of the step.
  void end_step() const { wall_->record_step(load_); }

 private:
  template <TangentialModel tangential>
  void add_block(int block, const WallBatch& batch);

  FixWallSdf* wall_;
  struct Candidate {
    int grain, tag, type;
    double touches_after;  // m, `travelled` before which there is no contact
  };

  std::vector<Candidate> candidates_;  // of ascending grains, as those of the fix
  std::vector<int> block_begin_;       // per block, and the end
  double swept_ = 0.0;                 // m, at least what any point of the wall has moved
  WallLoad load_;
};

}  // namespace gasgrain::plugins
