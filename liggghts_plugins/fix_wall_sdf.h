// fix ID group wall/sdf body FILE.h5 type T
// fix ID group wall/sdf case CASE.toml body NAME type T
//     [tangential history|no_history|off] [stiffness_exponent n]
//
// A wall from a signed distance field phi > 0 in the flow domain (eq 17-20):
//   contact while phi < r,   F_n = k (r - phi) grad(phi) - eta v_n n,   n = grad(phi)/|grad(phi)|
// with the exact gradient of the field as it is stored, so that the elastic force is the gradient
// of the potential 1/2 k (r - phi)^2 and conserves energy. k, eta, friction: pair (grain type, T)
// of the contact law (contact_law.hpp), scaled with the grain's l.
//
// One fix is one body; a grain may touch several bodies at once, so walls that meet at a concave
// corner belong into different bodies.
//
// Vector output f_ID[1..8]: force of the grains on the body (3, N), its torque about the origin
// (3, N m), number of contacts, largest overlap (m) of the present step.
#ifdef FIX_CLASS
// clang-format off
FixStyle(wall/sdf,gasgrain::plugins::FixWallSdf)
// clang-format on
#else
#pragma once

#include <fix.h>

#include <array>
#include <string>
#include <vector>

#include "coupling/shared/body.hpp"
#include "liggghts_plugins/contact_properties.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/contact_statistics.hpp"
#include "liggghts_plugins/grain_wall.hpp"
#include "liggghts_plugins/sphere_contact.hpp"

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
  double compute_vector(int index) override;
  int min_type() override { return wall_type_; }
  int max_type() override { return wall_type_; }

  // Per-atom tangential history: moves, is sorted, exchanged and restarted with the atom.
  void grow_arrays(int count) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override;
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;
  int pack_restart(int i, double* buffer) override;
  void unpack_restart(int i, int nth) override;
  int size_restart(int) override { return 4; }
  int maxsize_restart() override { return 4; }
  double memory_usage() override;

  const Body& body() const { return body_; }
  std::string wall_name() const override { return id; }
  Vec3 take_impulse() override { return impulse_.take(); }

  // For the fused engine, which computes the contacts itself between reneighbourings.
  int wall_type() const { return wall_type_; }
  TangentialModel tangential() const { return settings_.tangential; }
  const GrainContactTable& contacts() const { return contacts_; }
  const std::vector<int>& candidates() const { return candidates_; }  // ascending local indices
  std::vector<Vec3>& displacements() { return displacement_; }        // of every local atom, m

  // Sums over the contacts of this rank in one step.
  struct Load {
    Vec3 force = Vec3::Zero();   // on the body, N
    Vec3 torque = Vec3::Zero();  // on the body about the origin, N m
    double contacts = 0;
    LargestOverlap largest;
    // `force` acts on a grain at `point`.
    void add(const Vec3& force_on_grain, const Vec3& point, const LargestOverlap& overlap);
  };
  // Makes `load` that of the present step; not in the set-up of a run.
  void record_step(const Load& load);

 private:

  int read_body(int argument_count, char** arguments);
  void read_options(int argument_count, char** arguments);
  void refuse_unresolved_grains() const;
  template <TangentialModel tangential>
  void apply_contacts(const TangentialStep& step);
  template <TangentialModel tangential>
  void apply_contact(int i, const DistanceSample& wall, const TangentialStep& step);

  std::string where_;
  Body body_;
  int wall_type_ = 0;
  ContactSettings settings_;
  bool own_exponent_ = false;
  GrainContactTable contacts_;

  std::vector<Vec3> displacement_;  // tangential spring of each local atom, m
  std::vector<int> candidates_;     // local atoms that may touch until the next reneighbouring
  Load load_;
  std::array<double, 8> totals_{};  // over all ranks
  bool totals_valid_ = false;
  WallImpulse impulse_;
};

}  // namespace gasgrain::plugins
#endif
