// What the fused engine keeps of grains and contacts: plain records, laid out for vector loads.
//
// A contact test reads half a cache line of each grain, a contact force a line and a half, and the
// integrator the same lines once more while they are still in the first-level cache.
#pragma once

#include <cstddef>
#include <vector>

namespace gasgrain::plugins {

struct alignas(64) GrainRecord {
  double position[3];   // m
  double radius;        // m
  double velocity[3];   // m/s
  double inverse_mass;  // 1/kg
};

struct alignas(32) SpinRecord {
  double velocity[3];      // rad/s
  double inverse_inertia;  // 1/(kg m^2)
};

// Sum of the contact loads on a grain; the fourth values stay zero.
struct alignas(64) LoadRecord {
  double force[4];   // N
  double torque[4];  // N m
};

// Real: double, or float in mixed precision.
template <class Real>
struct SpringRecord {
  Real displacement[3];  // tangential, m
};

// Precision of contact forces and springs. Positions, radii, velocities, the test for contact, the
// sums of loads and the integration are always in double.
enum class Precision { full, mixed };

// Coefficients of the contact law of one pair (contact_law.hpp).
struct alignas(64) PairCoefficients {
  double k, eta;      // normal spring N/m and dashpot kg/s
  double k_t, eta_t;  // tangential
  double mu;
  double unused[3];
};

// Grains are worked on in blocks: contacts of a block's grains with all later ones, its walls, then
// its integration. Pairs are ordered first < second, so a block is complete when it is done.
constexpr int grains_per_block = 256;

// Pairs are tested and computed in groups of this many; lists are padded to whole groups per block.
constexpr int group_size = 8;

}  // namespace gasgrain::plugins
