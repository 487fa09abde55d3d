// The tests of pairs and velocity Verlet in vectors; contact forces are in contact_loads.hpp.
//
// Scheme: records of eight pairs are transposed in registers (gathers are slower).
// Velocity Verlet: the second half kick of a step and the first of the next are one (kick = dt).
// Assumes: pairs ordered first < second, lists padded to whole groups, spheres.
#include "liggghts_plugins/engine/kernel.hpp"

#include "liggghts_plugins/engine/contact_loads.hpp"
#include "liggghts_plugins/engine/pair_columns.hpp"

namespace gasgrain::plugins {
namespace {

GASGRAIN_LANES_INLINE unsigned nearer_than(const GrainRecord* grains, const int* first,
                                           const int* second, double margin) {
  const FourLanes<double> apart = separation(grains, first, second);
  const Vector<double> d = vector_of(apart);
  const Lanes<double> reach = apart.d + margin;
  return bits(dot(d, d) < reach * reach);
}

// Second grains of pairs lie layers of grains away in memory, in the second or third level of the
// cache; asking for them this much ahead made steps of dense beds a quarter to a third shorter.
constexpr int groups_ahead = 10;

GASGRAIN_LANES_INLINE void ask_for_grains(const GrainRecord* grains, const PairRange& pairs,
                                          int p) {
  if (p >= pairs.end) return;
  for (int lane = 0; lane < group_size; ++lane) __builtin_prefetch(grains + pairs.second[p + lane]);
}

int near_pairs(const GrainRecord* grains, const PairRange& pairs, double margin, int* places) {
  int count = 0;
  for (int p = pairs.begin; p < pairs.end; p += group_size) {
    unsigned set = nearer_than(grains, pairs.first + p, pairs.second + p, margin);
    if (pairs.end - p < group_size) set &= (1u << (pairs.end - p)) - 1u;
    count += write_places(places + count, p, set);
  }
  return count;
}

int partners(const SearchColumns& columns, const SearchRuns& runs, const SearchedGrain& grain,
             int* places) {
  const Lanes<float> x = all_lanes<float>(grain.x), y = all_lanes<float>(grain.y),
                     z = all_lanes<float>(grain.z), own = all_lanes<float>(grain.reach);
  const int i = grain.index;
  const LaneMask<float> index = {i, i, i, i, i, i, i, i};
  int count = 0;
  for (int run = 0; run < runs.count; ++run)
    for (int p = runs.begin[run]; p < runs.end[run]; p += group_size) {
      const Lanes<float> dx = load_lanes(columns.x + p) - x, dy = load_lanes(columns.y + p) - y,
                         dz = load_lanes(columns.z + p) - z;
      const Lanes<float> reach = load_lanes(columns.reach + p) + own;
      LaneMask<float> other;
      __builtin_memcpy(&other, columns.index + p, sizeof other);
      unsigned set = bits((dx * dx + dy * dy + dz * dz <= reach * reach) & (other > index));
      if (runs.end[run] - p < group_size) set &= (1u << (runs.end[run] - p)) - 1u;
      count += write_places(places + count, p, set);
    }
  return count;
}

template <class Real>
int touching_pairs(const GrainRecord* grains, const PairRange& pairs, unsigned char* touched,
                   SpringRecord<Real>* springs, int* places) {
  int count = 0;
  for (int p = pairs.begin; p < pairs.end; p += group_size) {
    ask_for_grains(grains, pairs, p + groups_ahead * group_size);
    const unsigned set = nearer_than(grains, pairs.first + p, pairs.second + p, 0.0);
    unsigned parted = touched[p / group_size] & ~set;
    touched[p / group_size] = static_cast<unsigned char>(set);
    for (; parted; parted &= parted - 1u) springs[p + __builtin_ctz(parted)] = {};
    count += write_places(places + count, p, set);
  }
  return count;
}

enum class Held { nothing, constant, with_drag };

template <Held held, bool some_fixed>
void integrate_block(IntegrationBatch& batch) {
  const double kick = batch.kick;
  const Quad<double> gravity = {batch.gravity[0] * kick, batch.gravity[1] * kick,
                                batch.gravity[2] * kick, 0.0};
  const Quad<double> drift = {batch.drift, batch.drift, batch.drift, 0.0};
  const Quad<double> no_fourth = {1.0, 1.0, 1.0, 0.0};
  Quad<double> fastest = {}, gas_sum = {};
  for (int i = batch.begin; i < batch.end; ++i) {
    GrainRecord& grain = batch.grains[i];
    SpinRecord& spin = batch.spins[i];
    LoadRecord& load = batch.ring.slots[i & batch.ring.mask];
    if constexpr (some_fixed) {
      if (batch.fixed[i]) {
        store_quad(load.force, Quad<double>{});
        store_quad(load.torque, Quad<double>{});
        continue;
      }
    }
    Quad<double> force = load_quad(load.force);
    if constexpr (held != Held::nothing) {
      const double* h = batch.held_forces + 3 * static_cast<std::size_t>(i);
      Quad<double> gas = {h[0], h[1], h[2], 0.0};
      if constexpr (held == Held::with_drag) {
        const double b = batch.drag[i];
        gas -= Quad<double>{b, b, b, 0.0} * load_quad(grain.velocity);
        gas_sum += gas;
      }
      force += gas;
    }
    // the fourth values are inverse mass and inertia, to which zero is added
    const Quad<double> velocity =
        load_quad(grain.velocity) + ((grain.inverse_mass * kick) * force + gravity);
    store_quad(grain.velocity, velocity);
    store_quad(grain.position, load_quad(grain.position) + drift * velocity);
    store_quad(spin.velocity,
               load_quad(spin.velocity) + (spin.inverse_inertia * kick) * load_quad(load.torque));
    store_quad(load.force, Quad<double>{});
    store_quad(load.torque, Quad<double>{});
    const Quad<double> square = no_fourth * velocity * velocity;
    const Quad<double> sum = square + __builtin_shufflevector(square, square, 1, 0, 3, 2);
    const Quad<double> total = sum + __builtin_shufflevector(sum, sum, 2, 3, 0, 1);
    fastest = total > fastest ? total : fastest;
  }
  batch.square_speed = fastest[0] > batch.square_speed ? fastest[0] : batch.square_speed;
  if constexpr (held == Held::with_drag)
    for (int d = 0; d < 3; ++d) batch.gas_force[d] += gas_sum[d];
}

template <Held held>
void integrate_held(IntegrationBatch& batch) {
  if (batch.fixed)
    integrate_block<held, true>(batch);
  else
    integrate_block<held, false>(batch);
}

void integrate(IntegrationBatch& batch) {
  if (batch.drag)
    integrate_held<Held::with_drag>(batch);
  else if (batch.held_forces)
    integrate_held<Held::constant>(batch);
  else
    integrate_held<Held::nothing>(batch);
}

}  // namespace

// Files that compile this one for a certain processor set both; see kernel_avx512.cpp.
#ifndef GASGRAIN_KERNEL
#define GASGRAIN_KERNEL kernel_generic
#define GASGRAIN_KERNEL_NAME "generic"
#endif
extern const ContactKernel GASGRAIN_KERNEL;
const ContactKernel GASGRAIN_KERNEL = {.name = GASGRAIN_KERNEL_NAME,
                                       .near_pairs = near_pairs,
                                       .partners = partners,
                                       .full = {touching_pairs<double>, contact_loads<double>},
                                       .mixed = {touching_pairs<float>, contact_loads<float>},
                                       .integrate = integrate};

}  // namespace gasgrain::plugins
