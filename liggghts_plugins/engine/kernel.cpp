// Contact forces of coarse grains (Mori, Wu, Sakai 2019, eq 7-9; contact_law.hpp in vectors) and
// velocity Verlet, eight pairs at a time.
//
// Scheme: records of eight pairs are transposed in registers (gathers are slower), touching pairs
// are packed densely before their forces are computed, and the loads of the eight pairs are added
// to their grains one after the other, in the order of the list: sums have a fixed order.
// Velocity Verlet: the second half kick of a step and the first of the next are one (kick = dt).
// Assumes: pairs ordered first < second, lists padded to whole groups, spheres.
#include "liggghts_plugins/engine/kernel.hpp"

#include "liggghts_plugins/engine/lanes.hpp"

namespace gasgrain::plugins {
namespace {

struct Vector {
  Lanes x, y, z;
};

GASGRAIN_LANES_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GASGRAIN_LANES_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
GASGRAIN_LANES_INLINE Vector operator*(Lanes s, const Vector& a) {
  return {s * a.x, s * a.y, s * a.z};
}
GASGRAIN_LANES_INLINE Lanes dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
GASGRAIN_LANES_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
GASGRAIN_LANES_INLINE Vector vector_of(const FourLanes& c) {
  return {c.a, c.b, c.c};
}

template <class Record>
GASGRAIN_LANES_INLINE FourLanes gather(const Record* base, const int* index, int offset) {
  const auto at = [&](int lane) {
    return reinterpret_cast<const double*>(base + index[lane]) + offset;
  };
  return columns(at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7));
}

// Offsets of the quads within GrainRecord.
constexpr int position_quad = 0, velocity_quad = 4;

GASGRAIN_LANES_INLINE unsigned nearer_than(const GrainRecord* grains, const int* first,
                                           const int* second, double margin) {
  const FourLanes a = gather(grains, first, position_quad);
  const FourLanes b = gather(grains, second, position_quad);
  const Vector d = vector_of(a) - vector_of(b);
  const Lanes reach = a.d + b.d + margin;
  return bits(dot(d, d) < reach * reach);
}

// Second grains of pairs lie layers of grains away in memory, in the second or third level of the
// cache; asking for them this much ahead made steps of dense beds a quarter to a third shorter.
constexpr int groups_ahead = 10, contact_groups_ahead = 2;

GASGRAIN_LANES_INLINE void ask_for_grains(const GrainRecord* grains, const PairRange& pairs,
                                          int p) {
  if (p >= pairs.end) return;
  for (int lane = 0; lane < group_size; ++lane) __builtin_prefetch(grains + pairs.second[p + lane]);
}

// The positions are near already: pairs have been tested just before.
GASGRAIN_LANES_INLINE void ask_for_contacts(const ContactBatch& batch, int c) {
  if (c + group_size > batch.count) return;
  for (int lane = 0; lane < group_size; ++lane) {
    const int second = batch.second[batch.contacts[c + lane]];
    __builtin_prefetch(batch.spins + second);
    __builtin_prefetch(batch.ring.slots + (second & batch.ring.mask), 1);
  }
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

int touching_pairs(const GrainRecord* grains, const PairRange& pairs, unsigned char* touched,
                   SpringRecord* springs, int* places) {
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

struct Coefficients {
  Lanes k, eta, k_t, eta_t, mu;
};

GASGRAIN_LANES_INLINE Coefficients coefficients_of(const PairCoefficients& c) {
  return {all_lanes(c.k), all_lanes(c.eta), all_lanes(c.k_t), all_lanes(c.eta_t), all_lanes(c.mu)};
}

GASGRAIN_LANES_INLINE Coefficients gather_coefficients(const PairCoefficients* base,
                                                       const int* index) {
  const FourLanes spring = gather(base, index, 0), friction = gather(base, index, 4);
  return {spring.a, spring.b, spring.c, spring.d, friction.a};
}

// Tangential force; `spring` is the tangential displacement and is advanced.
template <TangentialModel model>
GASGRAIN_LANES_INLINE Vector tangential_force(const Coefficients& c, Lanes normal_force,
                                              const Vector& n, const Vector& velocity,
                                              double slip_time, Vector& spring) {
  const Lanes limit = c.mu * (normal_force < 0.0 ? -normal_force : normal_force);
  if constexpr (model == TangentialModel::no_history) {
    const Lanes square = dot(velocity, velocity);
    const Lanes speed = root(square > 1e-300 ? square : all_lanes(1e-300));
    const Lanes dashpot = c.eta_t * speed <= limit ? c.eta_t : limit / speed;
    return -dashpot * velocity;
  }
  spring = spring + all_lanes(slip_time) * velocity;
  spring = spring - dot(spring, n) * n;
  const Lanes square = dot(spring, spring);
  const Lanes stretched = c.k_t * root(square > 1e-300 ? square : all_lanes(1e-300));
  const LaneMask sliding = stretched > limit;
  spring = (sliding ? limit / stretched : all_lanes(1.0)) * spring;
  const Lanes dashpot = sliding ? all_lanes(0.0) : c.eta_t;
  return -c.k_t * spring - dashpot * velocity;
}

GASGRAIN_LANES_INLINE Quad row(const FourLanes& rows, int lane) {
  const Lanes pair = lane % 4 == 0   ? rows.a
                     : lane % 4 == 1 ? rows.b
                     : lane % 4 == 2 ? rows.c
                                     : rows.d;
  return lane < 4 ? low_half(pair) : high_half(pair);
}

GASGRAIN_LANES_INLINE void add(double* aligned, Quad value) {
  store_quad(aligned, load_quad(aligned) + value);
}

// Hertz's springs and dashpots at this overlap.
GASGRAIN_LANES_INLINE Coefficients stiffened(const Coefficients& c, Lanes overlap) {
  const Lanes spring = root(overlap > 0.0 ? overlap : all_lanes(0.0)), dashpot = root(spring);
  return {c.k * spring, c.eta * dashpot, c.k_t * spring, c.eta_t * dashpot, c.mu};
}

template <NormalModel normal, TangentialModel model, bool uniform>
GASGRAIN_LANES_INLINE void loads_of_group(ContactBatch& batch, const int* places, LaneMask valid,
                                          const Coefficients& common, Lanes& largest_overlap,
                                          Lanes& largest_relative) {
  alignas(32) int first[group_size], second[group_size];
  for (int lane = 0; lane < group_size; ++lane) {
    first[lane] = batch.first[places[lane]];
    second[lane] = batch.second[places[lane]];
  }
  const FourLanes place_i = gather(batch.grains, first, position_quad);
  const FourLanes place_j = gather(batch.grains, second, position_quad);
  const Vector delta = vector_of(place_i) - vector_of(place_j);
  const Lanes distance = root(dot(delta, delta));
  const Vector n = (1.0 / distance) * delta;
  const Lanes radii = place_i.d + place_j.d;
  const Lanes overlap = valid ? radii - distance : all_lanes(0.0);
  largest_overlap = overlap > largest_overlap ? overlap : largest_overlap;
  const LaneMask record = overlap > largest_relative * radii;
  if (bits(record)) largest_relative = record ? overlap / radii : largest_relative;

  const Vector v = vector_of(gather(batch.grains, first, velocity_quad)) -
                   vector_of(gather(batch.grains, second, velocity_quad));
  const Lanes lever_i = place_i.d - 0.5 * overlap, lever_j = place_j.d - 0.5 * overlap;
  const Vector spin = lever_i * vector_of(gather(batch.spins, first, 0)) +
                      lever_j * vector_of(gather(batch.spins, second, 0));
  const Lanes v_n = dot(v, n);
  const Vector v_t = (v - v_n * n) + cross(n, spin);

  Coefficients c = uniform ? common : gather_coefficients(batch.coefficients, places);
  if constexpr (normal == NormalModel::hertz) c = stiffened(c, overlap);
  const Lanes force_n = c.k * overlap - c.eta * v_n;
  const Lanes f_n =
      force_n > batch.least_normal_force ? force_n : all_lanes(batch.least_normal_force);
  Vector force = f_n * n;
  Vector moment = {};
  if constexpr (model != TangentialModel::off) {
    Vector spring = {};
    if constexpr (model == TangentialModel::history)
      spring = vector_of(gather(batch.springs, places, 0));
    const Vector f_t = tangential_force<model>(c, f_n, n, v_t, batch.slip_time, spring);
    force = force + f_t;
    moment = cross(f_t, n);
    if constexpr (model == TangentialModel::history) {
      const FourLanes rows = transposed({spring.x, spring.y, spring.z, Lanes{}});
#pragma GCC unroll 8
      for (int lane = 0; lane < group_size; ++lane)
        store_quad(batch.springs[places[lane]].displacement, row(rows, lane));
    }
  }

  const Lanes on = valid ? all_lanes(1.0) : all_lanes(0.0);
  const FourLanes forces = transposed({on * force.x, on * force.y, on * force.z, Lanes{}});
  const Vector moment_i = (on * lever_i) * moment, moment_j = (on * lever_j) * moment;
  const FourLanes torques_i = transposed({moment_i.x, moment_i.y, moment_i.z, Lanes{}});
  const FourLanes torques_j = transposed({moment_j.x, moment_j.y, moment_j.z, Lanes{}});
  const LoadRing& ring = batch.ring;
#pragma GCC unroll 8
  for (int lane = 0; lane < group_size; ++lane) {
    LoadRecord& i = ring.slots[first[lane] & ring.mask];
    LoadRecord& j =
        ring.slots[second[lane] < ring.local_count ? second[lane] & ring.mask : ring.discarded];
    const Quad f = row(forces, lane);
    add(i.force, f);
    add(i.torque, row(torques_i, lane));
    add(j.force, -f);
    add(j.torque, row(torques_j, lane));
  }
}

GASGRAIN_LANES_INLINE double largest_lane(Lanes a, double start) {
  for (int lane = 0; lane < group_size; ++lane) start = a[lane] > start ? a[lane] : start;
  return start;
}

template <NormalModel normal, TangentialModel model, bool uniform>
void loads(ContactBatch& batch) {
  for (int lane = 0; lane < group_size; ++lane) batch.contacts[batch.count + lane] = batch.dummy;
  const Coefficients common = coefficients_of(batch.coefficients[0]);
  const LaneMask lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  Lanes overlap = {}, relative = {};
  for (int c = 0; c < batch.count; c += group_size) {
    ask_for_contacts(batch, c + contact_groups_ahead * group_size);
    const LaneMask valid = lanes < static_cast<long long>(batch.count - c);
    loads_of_group<normal, model, uniform>(batch, batch.contacts + c, valid, common, overlap,
                                           relative);
  }
  batch.largest[0] = largest_lane(overlap, batch.largest[0]);
  batch.largest[1] = largest_lane(relative, batch.largest[1]);
}

template <NormalModel normal, TangentialModel model>
void loads_of_models(ContactBatch& batch, bool uniform) {
  if (uniform)
    loads<normal, model, true>(batch);
  else
    loads<normal, model, false>(batch);
}

template <NormalModel normal>
void loads_of_normal_model(ContactBatch& batch, TangentialModel model, bool uniform) {
  switch (model) {
    case TangentialModel::off:
      return loads_of_models<normal, TangentialModel::off>(batch, uniform);
    case TangentialModel::no_history:
      return loads_of_models<normal, TangentialModel::no_history>(batch, uniform);
    case TangentialModel::history:
      return loads_of_models<normal, TangentialModel::history>(batch, uniform);
  }
}

void contact_loads(ContactBatch& batch, const PairModel& model, bool uniform) {
  switch (model.normal) {
    case NormalModel::linear:
      return loads_of_normal_model<NormalModel::linear>(batch, model.tangential, uniform);
    case NormalModel::hertz:
      return loads_of_normal_model<NormalModel::hertz>(batch, model.tangential, uniform);
  }
}

enum class Held { nothing, constant, with_drag };

template <Held held, bool some_fixed>
void integrate_block(IntegrationBatch& batch) {
  const double kick = batch.kick;
  const Quad gravity = {batch.gravity[0] * kick, batch.gravity[1] * kick, batch.gravity[2] * kick,
                        0.0};
  const Quad drift = {batch.drift, batch.drift, batch.drift, 0.0};
  const Quad no_fourth = {1.0, 1.0, 1.0, 0.0};
  Quad fastest = {}, gas_sum = {};
  for (int i = batch.begin; i < batch.end; ++i) {
    GrainRecord& grain = batch.grains[i];
    SpinRecord& spin = batch.spins[i];
    LoadRecord& load = batch.ring.slots[i & batch.ring.mask];
    if constexpr (some_fixed) {
      if (batch.fixed[i]) {
        store_quad(load.force, Quad{});
        store_quad(load.torque, Quad{});
        continue;
      }
    }
    Quad force = load_quad(load.force);
    if constexpr (held != Held::nothing) {
      const double* h = batch.held_forces + 3 * static_cast<std::size_t>(i);
      Quad gas = {h[0], h[1], h[2], 0.0};
      if constexpr (held == Held::with_drag) {
        const double b = batch.drag[i];
        gas -= Quad{b, b, b, 0.0} * load_quad(grain.velocity);
        gas_sum += gas;
      }
      force += gas;
    }
    // the fourth values are inverse mass and inertia, to which zero is added
    const Quad velocity =
        load_quad(grain.velocity) + ((grain.inverse_mass * kick) * force + gravity);
    store_quad(grain.velocity, velocity);
    store_quad(grain.position, load_quad(grain.position) + drift * velocity);
    store_quad(spin.velocity,
               load_quad(spin.velocity) + (spin.inverse_inertia * kick) * load_quad(load.torque));
    store_quad(load.force, Quad{});
    store_quad(load.torque, Quad{});
    const Quad square = no_fourth * velocity * velocity;
    const Quad sum = square + __builtin_shufflevector(square, square, 1, 0, 3, 2);
    const Quad total = sum + __builtin_shufflevector(sum, sum, 2, 3, 0, 1);
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
const ContactKernel GASGRAIN_KERNEL = {GASGRAIN_KERNEL_NAME, near_pairs, touching_pairs,
                                       contact_loads, integrate};

}  // namespace gasgrain::plugins
