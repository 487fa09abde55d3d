// Reading flows on one rank: values between the grid points, forces by control volumes, and how
// steady states are reached.
#pragma once

#include <functional>
#include <vector>

#include "cfd/gas_solver.hpp"

namespace gasgrain::verification {

// Trilinear between the faces of direction d, m/s.
double velocity_at(const cfd::GasSolver& solver, int d, const Vec3& x);
// Trilinear between cell centres, Pa.
double pressure_at(const cfd::GasSolver& solver, const Vec3& x);

// The velocity of `solver` as it is now, to start a finer grid from.
std::function<Vec3(const Vec3&)> sampled_velocity(const cfd::GasSolver& solver);

// Advances by `duration` (s) in equal steps a little below the largest stable one at its start. (A
// change of step changes the pressure force on bodies for a while: what the flow next to them
// misses of the no-slip condition is proportional to the step.)
void advance_by(cfd::GasSolver& solver, double duration);

// Advances until `watched` changes by less than `tolerance` of itself per `duration` (s), and no
// longer than `limit` durations. Returns the durations taken.
int advance_until_steady(cfd::GasSolver& solver, double duration, double tolerance, int limit,
                         const std::function<double()>& watched);

// Force on what lies between the planes x = lower[0], x = upper[0], z = lower[2], z = upper[2]
// (grid planes, in gas) of a flow in the x-z plane, N: what pressure, viscous stress and momentum
// bring in through them. In an unsteady flow the growth of momentum_between has to be taken off.
Vec3 force_between(const cfd::GasSolver& solver, const Vec3& lower, const Vec3& upper);
Vec3 momentum_between(const cfd::GasSolver& solver, const Vec3& lower, const Vec3& upper);

// Signal over time: mean of the extremes, and frequency from upward crossings of its mean, of the
// samples at and after `start` (s).
struct Oscillation {
  double largest = 0.0, smallest = 0.0, mean = 0.0;
  double frequency = 0.0;  // Hz; 0 with less than two crossings
  int periods = 0;
};
Oscillation oscillation_after(double start, const std::vector<double>& times,
                              const std::vector<double>& values);

}  // namespace gasgrain::verification
