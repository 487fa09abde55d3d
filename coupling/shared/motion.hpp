// Rigid motion of a body as a pure function of time: pose, velocity of its points, moved shape.
//
// A point x0 of the body at t = 0 is at time t at
//
//   x = c + s(t) + R(t) (x0 - c),     s(t) = V tau + A ( sin(2 pi tau / T + phase) - sin(phase) ),
//
// with c a point of the rotation axis, R(t) the turn by rate tau about it (right-handed), and tau
// the time since `start`, not beyond `stop`. The axis travels with the body. Before `start` and
// after `stop` the body stands still.
#pragma once

#include <limits>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/signed_distance.hpp"

namespace gasgrain {

// Turn by `angle` [rad], right-handed, about a unit vector.
Mat3 rotation_about(const Vec3& axis, double angle);

// Where a body is: x = rotation * x0 + translation for its point that was at x0 at t = 0.
struct Pose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();  // m

  Vec3 to_world(const Vec3& x0) const { return rotation * x0 + translation; }
  Vec3 to_body(const Vec3& x) const { return rotation.transpose() * (x - translation); }
};

struct Motion {
  Vec3 velocity = Vec3::Zero();                           // V, m/s
  Vec3 amplitude = Vec3::Zero();                          // A, m
  double period = 1.0;                                    // T, s, > 0
  double phase = 0.0;                                     // rad
  Vec3 centre = Vec3::Zero();                             // c, m
  Vec3 axis = Vec3::UnitZ();                              // unit vector
  double rate = 0.0;                                      // rad/s
  double start = 0.0;                                     // s
  double stop = std::numeric_limits<double>::infinity();  // s, >= start
  // Only the surface moves, the shape stays where it is: a roll that turns about its own axis.
  bool surface_only = false;

  // Some point of the surface moves at some time.
  bool is_at_rest() const { return velocity.isZero(0) && amplitude.isZero(0) && rate == 0.0; }
  // The body occupies other places at other times.
  bool sweeps() const { return !is_at_rest() && !surface_only; }
  // The body moves at times t with first < t < last.
  bool moves_between(double first, double last) const {
    return !is_at_rest() && last > start && first < stop;
  }

  // Identity for surface_only.
  Pose pose(double time) const;
  // Translation of the axis since t = 0, m.
  Vec3 displacement(double time) const;
  // Velocity of the axis, m/s, and angular velocity, rad/s.
  Vec3 translation_velocity(double time) const;
  Vec3 angular_velocity(double time) const;
  // Velocity of the point of the body that is at x [m] at this time, m/s.
  Vec3 velocity_at(const Vec3& x, double time) const;
};

// Reads the `motion` table of a [[body]] (keys: docs/geometry.md). Throws UserError: no motion in
// it, zero axis, period not positive, stop before start, unknown keys.
Motion read_motion(const ConfigTable& table);

// The shape seen through a pose: distance and gradient at x are those of the body at rest at
// pose.to_body(x), the gradient turned back.
Shape move_shape(Shape at_rest, const Pose& pose);

}  // namespace gasgrain
