// fix ID group wall/sdf body FILE.h5 type T
// fix ID group wall/sdf case CASE.toml body NAME type T
//     [tangential history|no_history|off] [stiffness_exponent n] [motion keywords: wall_motion.hpp]
//
// A wall from a signed distance field phi > 0 in the flow domain (sdf_wall.hpp): at rest or moving
// as the body's `motion` says. k, eta, friction: pair (grain type, T) of the contact law
// (contact_law.hpp), scaled with the grain's l. One fix is one body.
//
// Vector output f_ID[1..8]: force of the grains on the body (3, N), its torque about the body's
// torque point (3, N m), number of contacts, largest overlap (m) of the present step.
#ifdef FIX_CLASS
// clang-format off
FixStyle(wall/sdf,gasgrain::plugins::FixWallSdf)
// clang-format on
#else
// no #pragma once: the same file is read again under *_CLASS
#ifndef GASGRAIN_FIX_WALL_SDF_H
#define GASGRAIN_FIX_WALL_SDF_H

#include <fix.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "coupling/shared/body.hpp"
#include "liggghts_plugins/contact_properties.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/grain_wall.hpp"
#include "liggghts_plugins/sdf_wall.hpp"
#include "liggghts_plugins/wall_motion.hpp"

namespace gasgrain::plugins {

class FixWallSdf : public LAMMPS_NS::Fix, public GrainWall {
 public:
  FixWallSdf(LAMMPS_NS::LAMMPS* liggghts, int argument_count, char** arguments);
  ~FixWallSdf() override;

  int setmask() override;
  void init() override;
  void setup(int vflag) override;
  void setup_pre_neighbor() override { pre_neighbor(); }
  void pre_neighbor() override;
  void post_force(int vflag) override;
  void post_run() override;
  double compute_vector(int index) override;
  int min_type() override { return wall_.wall_type(); }
  int max_type() override { return wall_.wall_type(); }

  // Per-atom tangential history: moves, is sorted, exchanged and restarted with the atom.
  void grow_arrays(int count) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override;
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int nth) override;
  int size_restart(int i) override;
  int maxsize_restart() override;
  double memory_usage() override;
  // Where a wall that variables move has come to.
  void write_restart(FILE* file) override;
  void restart(char* buffer) override;

  std::string wall_name() const override { return id; }
  Vec3 take_impulse() override { return impulse_.take(); }
  bool surface_moves() const override {
    return motion_.by_variable.exists() || !wall_.body().motion.is_at_rest();
  }

  // For the fused engine, which computes the contacts itself between reneighbourings.
  SdfWall& wall() { return wall_; }
  TangentialModel tangential() const { return settings_.tangential; }
  // Moved by variables that look at more than the time, such as sums over grains.
  bool looks_at_grains() const {
    return motion_.by_variable.exists() && !motion_.by_variable.follows_time(*lmp);
  }
  int tag(int i) const;
  int type(int i) const;
  // Puts the wall where it is in the present step.
  void place_wall();
  double step_duration() const;  // s
  // Fastest that the wall sweeps through the simulation box, m/s.
  double fastest_sweep() const;
  const std::vector<int>& candidates() const { return candidates_; }  // ascending local indices
  std::vector<Vec3>& springs() { return springs_; }                   // tangential, of these, m
  // Around candidate c; one for all where none are remembered.
  LocalWalls& local_walls(std::size_t c) { return local_walls_[wall_.has_local_walls() ? c : 0]; }

  // Makes `load` that of the present step; not in the set-up of a run.
  void record_step(const WallLoad& load);

 private:
  std::pair<Body, int> read_body(int argument_count, char** arguments) const;
  int read_options(int argument_count, char** arguments);
  void refuse_unresolved_grains() const;
  void take_motion(Body& body, const char* case_file) const;
  void carry_wall();
  void note_load();
  template <TangentialModel tangential>
  void apply_contacts(const TangentialStep& step);
  Vec3 spring_of(int i) const { return place_[i] < 0 ? Vec3(Vec3::Zero()) : springs_[place_[i]]; }
  std::vector<double> packed_springs(int i) const;
  void unpack_springs(int i, const double* values);

  std::string where_;
  SdfWall wall_;
  ContactSettings settings_;
  WallMotion motion_;   // by keywords
  double way_ = 0.0;    // m, that the wall may come nearer before new lists
  double swept_ = 0.0;  // m, by variables since the lists were built
  bool own_exponent_ = false;

  std::vector<int> candidates_;  // local atoms that may touch until the next reneighbouring
  std::vector<Vec3> springs_;    // tangential springs of the candidates, m; then of newcomers
  std::vector<LocalWalls> local_walls_;  // around the candidates
  std::vector<int> place_;               // of an atom's spring in springs_; -1: none
  WallLoad load_;
  double unsure_contacts_ = 0.0;  // of this rank since they were last reported
  std::array<double, 8> totals_{};  // over all ranks
  bool totals_valid_ = false;
  WallImpulse impulse_;
};

}  // namespace gasgrain::plugins
#endif
#endif
