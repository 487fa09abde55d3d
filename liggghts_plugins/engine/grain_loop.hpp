// The inner loop of the fused engine: everything between two reneighbourings, without LIGGGHTS.
//
// Protocol: load the grains (start, set_grain for all, candidates, touching pairs, walls), then per
// step: positions of the present step are in the records (ghosts too) -> prepare() -> force_pass().
// A pass adds up all loads and moves the grains on to the next step; an `observer` sees the
// complete load of each block before.
//
// A local grain comes to its final load when its block is done, because pairs are ordered: the
// block is integrated while it is in cache, and nobody reads its old position afterwards.
#pragma once

#include <functional>
#include <vector>

#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/engine/contact_list.hpp"
#include "liggghts_plugins/engine/held_force.hpp"
#include "liggghts_plugins/engine/pair_law.hpp"
#include "liggghts_plugins/engine/wall_contacts.hpp"

namespace gasgrain::plugins {

struct GrainCounts {
  int local = 0;
  int ghost = 0;
  int total() const { return local + ghost; }
};

// State of one grain outside of the loop.
struct GrainState {
  const double* position;  // m
  const double* velocity;  // m/s
  const double* spin;      // rad/s
  PairMember contact;      // type, mass, radius
  bool fixed;              // keeps place and velocity, whatever acts on it
};

struct PassSettings {
  TangentialStep slip;
  double kick;      // s, velocities: dt, or dt/2 when the step ends here
  double drift;     // s, positions: dt, or 0
  Vec3 gravity;     // m/s^2
  HeldForces held;  // per local grain
};

// A load that comes from outside of the loop.
struct GrainLoad {
  int grain;
  Vec3 force;   // N
  Vec3 torque;  // N m
};

class GrainLoop {
 public:
  // Called for every local grain with its contact load, before integration.
  using Observer = std::function<void(int grain, const LoadRecord& load)>;

  void start(GrainCounts counts, const PairLaw& law, PairCounts room, Precision precision);
  void set_grain(int i, const GrainState& state);
  ContactList& pairs() { return pairs_; }
  std::vector<WallContacts>& walls() { return walls_; }
  // Loads of the next pass from outside: lists of ascending grains.
  std::vector<std::vector<GrainLoad>>& outside_loads() { return outside_loads_; }
  // After all of the above. `skin`: distance of the surfaces of candidates, m.
  void finish_loading(double skin);

  GrainCounts counts() const { return counts_; }
  GrainRecord& grain(int i) { return grains_[i]; }
  const GrainRecord& grain(int i) const { return grains_[i]; }
  SpinRecord& spin(int i) { return spins_[i]; }
  bool is_fixed(int i) const { return fixed_[i] != 0; }
  // From now on the grain keeps place and velocity, or does not any more.
  void fix_grain(int i) {
    fixed_[i] = 1;
    some_fixed_ = true;
  }
  void free_grain(int i) { fixed_[i] = 0; }

  // Tells that all grains, ghosts too, moved by at most this, m. Kept for the near pairs and walls.
  void note_travel(double distance);
  double travelled() const { return travelled_; }  // m since loading, bound
  void force_pass(const PassSettings& settings, const Observer* observer);
  double square_speed() const { return square_speed_; }  // largest of the last pass, m^2/s^2
  // Sum over the local grains in the last pass, N; 0 when none follows the velocity.
  const Vec3& held_force_sum() const { return held_force_sum_; }
  LargestOverlap largest_overlap() const { return {largest_[0], largest_[1]}; }

 private:
  void note_member(int i, const PairMember& member);
  // All grains are alike, and all pairs have the same coefficients.
  bool uniform() const { return members_.size() == 1; }
  const PairMember& member(int i) const { return members_[uniform() ? 0 : i]; }
  void size_ring();
  void choose_near_pairs();
  void add_outside_loads(int end);

  GrainCounts counts_;
  const PairLaw* law_ = nullptr;
  std::vector<GrainRecord> grains_;  // local, ghosts, two that never touch
  std::vector<SpinRecord> spins_;
  std::vector<PairMember> members_;  // of all grains, or one that all of them are like
  std::vector<unsigned char> fixed_;
  bool some_fixed_ = false;
  std::vector<LoadRecord> loads_;
  LoadRing ring_{};
  ContactList pairs_;
  std::vector<WallContacts> walls_;
  std::vector<std::vector<GrainLoad>> outside_loads_;
  std::vector<std::size_t> outside_done_;  // loads of each list that have been added
  double near_margin_ = 0;                 // m
  double near_travelled_ = 0;              // m since the near pairs were chosen
  double travelled_ = 0;                   // m since loading
  double square_speed_ = 0;
  Vec3 held_force_sum_ = Vec3::Zero();
  double largest_[2] = {0, 0};
};

}  // namespace gasgrain::plugins
