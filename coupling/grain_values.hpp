// What each grain keeps from exchange to exchange and takes along from rank to rank: its gas force
// and, when they are wanted, what the drag needs that follows the grain, and a label.
#pragma once

#include <vector>

#include "coupling/shared/vec3.hpp"
#include "liggghts_plugins/engine/held_force.hpp"

namespace gasgrain::coupling {

// Indices are LIGGGHTS's local atoms.
class GrainValues {
 public:
  // Before the first resize().
  void keep_labels() { labelled_ = true; }
  void let_drag_follow() { drag_follows_ = true; }

  void resize(int count);
  int per_grain() const { return 3 + (labelled_ ? 1 : 0) + (drag_follows_ ? 7 : 0); }
  double bytes() const { return double(held_.size()) * per_grain() * sizeof(double); }
  void pack(int i, double* buffer) const;  // writes per_grain() numbers
  void unpack(int i, const double* buffer);
  void copy(int from, int to);
  void clear(int i);

  // No grain holds a force any more.
  void release();
  // What a grain holds from now on: `force` [N] with the drag at its `velocity` [m/s] and at
  // `position` [m]; `coefficient` [kg/s] of the drag if it follows; the gas gives `force` over
  // `interval` [s].
  struct Exchanged {
    Vec3 force;
    double coefficient = 0.0;
    double interval = 0.0;
    Vec3 position, velocity;
  };
  void hold(int i, const Exchanged& exchanged);

  plugins::HeldForces forces() const;
  const Vec3& held(int i) const { return held_[i]; }

  bool drag_follows() const { return drag_follows_; }
  // Where the grain was at the last exchange, m; only if the drag follows.
  const Vec3& position(int i) const { return positions_[i]; }
  // N s: what the grain received beyond what the gas gave, when it has moved by `path` [m] in the
  // `elapsed` time [s] of an interval and the gas gave over `given` [s]. The forces of the steps,
  // computed with the velocities by which the grain moved, add up to held T - B path. `path` is
  // not read unless the drag follows.
  Vec3 received_beyond(int i, const Vec3& path, double elapsed, double given) const;

  double& label(int i) { return labels_[i]; }
  double label(int i) const { return labels_[i]; }

 private:
  template <class Self, class Visit>
  static void visit(Self& self, int i, Visit&& visit);

  bool labelled_ = false, drag_follows_ = false;
  // The gas force is held - coefficient * velocity.
  std::vector<Vec3> held_;            // N
  std::vector<double> coefficients_;  // kg/s; empty, as the next two, unless the drag follows
  std::vector<Vec3> given_;           // N s, what the gas gave for the present forces
  std::vector<Vec3> positions_;       // m, at the last exchange
  std::vector<double> labels_;        // empty unless kept
};

}  // namespace gasgrain::coupling
