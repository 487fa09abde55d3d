// The vector code of the fused engine: loops over plain records and columns.
//
// Compiled once per instruction set (kernel.cpp), chosen at run time by contact_kernel(); results
// agree within round-off, and are the same bits in every run on the same machine.
#pragma once

#include <string>
#include <type_traits>

#include "liggghts_plugins/engine/pair_law.hpp"
#include "liggghts_plugins/engine/records.hpp"

namespace gasgrain::plugins {

struct PairRange {
  const int* first;   // index of the grain with the smaller index
  const int* second;  // may be read up to one group beyond the end, as `first`
  int begin, end;
};

// Where loads are collected. Slots of a ring are free again when their grain has been integrated:
// accumulators of a large bed stay in cache. The load on a ghost is not wanted: its own rank
// computes it.
struct LoadRing {
  LoadRecord* slots;
  int mask;         // size of the ring (a power of two) - 1; the slot of a grain is index & mask
  int discarded;    // slot for what nobody wants
  int local_count;  // grains from this index on are ghosts
};

struct ContactBatch {
  const GrainRecord* grains;
  const SpinRecord* spins;
  const int* first;                      // of all pairs of the list
  const int* second;                     // of all pairs of the list
  const PairCoefficients* coefficients;  // one per pair of the list, or a single one
  LoadRing ring;
  int* contacts;  // places in the list; may be written up to one group beyond the end
  int count;
  int dummy;                  // place in the list of a pair without effect, used as padding
  double slip_time;           // s
  double least_normal_force;  // N
  double* largest;            // overlap (m) and overlap / sum of radii so far
};

struct IntegrationBatch {
  GrainRecord* grains;
  SpinRecord* spins;
  LoadRing ring;
  const double* held_forces;   // N, three per grain, or nullptr
  const double* drag;          // kg/s, to be multiplied with minus the velocity, or nullptr
  const unsigned char* fixed;  // not 0: neither moves nor changes its velocity; or nullptr
  int begin, end;
  double gravity[3];    // m/s^2
  double kick;          // s, for velocities
  double drift;         // s, for positions
  double square_speed;  // largest so far, m^2/s^2; updated
  double gas_force[3];  // N, sum of held forces and drag so far; updated when there is drag
};

// Grains in the order of their search bins. Lengths in m, positions from a corner that is near.
struct SearchColumns {
  const float* x;
  const float* y;
  const float* z;
  const float* reach;  // how far they reach towards a partner
  const int* index;    // of the grain; as the others readable one group beyond the end
};

// Places in the columns in which partners are looked for, run after run.
struct SearchRuns {
  const int* begin;
  const int* end;
  int count;
};

struct SearchedGrain {
  float x, y, z, reach;
  int index;
};

// What depends on the precision of forces and springs.
template <class Real>
struct ForceKernel {
  // As ContactKernel::near_pairs for touching pairs of whole groups, with memory: `touched` holds a
  // bit per pair, and springs of pairs that have parted are set to zero.
  int (*touching_pairs)(const GrainRecord*, const PairRange&, unsigned char* touched,
                        SpringRecord<Real>* springs, int* places);
  // Adds the loads of the contacts to the ring and advances the springs of the list, of which one
  // value more is read behind the last contact's. `uniform`: all grains are alike.
  void (*contact_loads)(ContactBatch&, SpringRecord<Real>* springs, const PairModel&, bool uniform);
};

struct ContactKernel {
  const char* name;
  // Writes the places of pairs whose surfaces are nearer than `margin` (m); returns their number.
  // `places` has room for the range and one group more.
  int (*near_pairs)(const GrainRecord*, const PairRange&, double margin, int* places);
  // Writes the places of grains of a larger index that the grain's and their reach join; returns
  // their number. `places` has room for all runs and one group more.
  int (*partners)(const SearchColumns&, const SearchRuns&, const SearchedGrain&, int* places);
  ForceKernel<double> full;
  ForceKernel<float> mixed;
  // v += a kick, x += v drift for the block, and sets its loads to zero.
  void (*integrate)(IntegrationBatch&);
};

template <class Real>
const ForceKernel<Real>& force_kernel(const ContactKernel& kernel) {
  if constexpr (std::is_same_v<Real, double>)
    return kernel.full;
  else
    return kernel.mixed;
}

// The best one for this processor, unless another one was chosen.
const ContactKernel& contact_kernel();
// By name; throws UserError that lists those this processor can run.
void choose_contact_kernel(const std::string& name);

}  // namespace gasgrain::plugins
