// Contact forces of coarse grains (Mori, Wu, Sakai 2019, eq 7-9; contact_law.hpp in vectors), eight
// pairs at a time, in double or single precision.
//
// Scheme: touching pairs are packed densely before their forces are computed, and the loads of the
// eight pairs are added to their grains one after the other, in the order of the list: sums have a
// fixed order. Sums are in double in any precision, with the same force on both grains of a pair:
// momentum is conserved to the round-off of double.
// Assumes: pairs ordered first < second, spheres, and in the place `dummy` of the list two grains
// that rest without touching.
#pragma once

#include <limits>
#include <type_traits>

#include "liggghts_plugins/engine/pair_columns.hpp"

namespace gasgrain::plugins {
namespace {

constexpr int contact_groups_ahead = 2;

// The positions are near already: pairs have been tested just before.
template <class Real>
GASGRAIN_LANES_INLINE void ask_for_contacts(const ContactBatch& batch,
                                            const SpringRecord<Real>* springs, int c) {
  if (c + group_size > batch.count) return;
  for (int lane = 0; lane < group_size; ++lane) {
    const int place = batch.contacts[c + lane], second = batch.second[place];
    __builtin_prefetch(springs + place, 1);
    __builtin_prefetch(batch.spins + second);
    __builtin_prefetch(batch.ring.slots + (second & batch.ring.mask), 1);
  }
}

template <class Real>
struct Coefficients {
  Lanes<Real> k, eta, k_t, eta_t, mu;
};

template <class Real>
GASGRAIN_LANES_INLINE Coefficients<Real> coefficients_of(const PairCoefficients& c) {
  return {all_lanes<Real>(c.k), all_lanes<Real>(c.eta), all_lanes<Real>(c.k_t),
          all_lanes<Real>(c.eta_t), all_lanes<Real>(c.mu)};
}

template <class Real>
GASGRAIN_LANES_INLINE Coefficients<Real> gather_coefficients(const PairCoefficients* base,
                                                             const int* index) {
  const FourLanes<Real> spring = columns<Real>(rows<double>(base, index, 0));
  const FourLanes<Real> friction = columns<Real>(rows<double>(base, index, 4));
  return {spring.a, spring.b, spring.c, spring.d, friction.a};
}

// Hertz's springs and dashpots at this overlap.
template <class Real>
GASGRAIN_LANES_INLINE Coefficients<Real> stiffened(const Coefficients<Real>& c,
                                                   Lanes<Real> overlap) {
  const Lanes<Real> spring = root(overlap > 0 ? overlap : all_lanes<Real>(0.0));
  const Lanes<Real> dashpot = root(spring);
  return {c.k * spring, c.eta * dashpot, c.k_t * spring, c.eta_t * dashpot, c.mu};
}

template <class Real>
struct Geometry {
  Lanes<Real> radii, distance, overlap;
  Vector<Real> n;
};

// The overlap R - d is a small part of both. In single precision it keeps its digits by
// (R^2 - d^2) / (R + d) with the difference of squares from double.
template <class Real>
GASGRAIN_LANES_INLINE Geometry<Real> geometry_of(const FourLanes<double>& separation) {
  const Vector<double> delta = vector_of(separation);
  const Lanes<double> radii = separation.d, square = dot(delta, delta);
  const Vector<Real> towards_first = {rounded<Real>(delta.x), rounded<Real>(delta.y),
                                      rounded<Real>(delta.z)};
  Geometry<Real> g;
  g.radii = rounded<Real>(radii);
  g.distance = root(rounded<Real>(square));
  if constexpr (std::is_same_v<Real, double>)
    g.overlap = radii - g.distance;
  else
    g.overlap = rounded<Real>(radii * radii - square) / (g.radii + g.distance);
  g.n = (1 / g.distance) * towards_first;
  return g;
}

// Tangential force; `spring` is the tangential displacement and is advanced.
template <class Real, TangentialModel model>
GASGRAIN_LANES_INLINE Vector<Real> tangential_force(const Coefficients<Real>& c,
                                                    Lanes<Real> normal_force, const Vector<Real>& n,
                                                    const Vector<Real>& velocity, double slip_time,
                                                    Vector<Real>& spring) {
  const Lanes<Real> limit = c.mu * (normal_force < 0 ? -normal_force : normal_force);
  const Lanes<Real> least = all_lanes<Real>(std::numeric_limits<Real>::min());
  if constexpr (model == TangentialModel::no_history) {
    const Lanes<Real> square = dot(velocity, velocity);
    const Lanes<Real> speed = root(square > least ? square : least);
    const Lanes<Real> dashpot = c.eta_t * speed <= limit ? c.eta_t : limit / speed;
    return -dashpot * velocity;
  }
  spring = spring + all_lanes<Real>(slip_time) * velocity;
  spring = spring - dot(spring, n) * n;
  const Lanes<Real> square = dot(spring, spring);
  const Lanes<Real> stretched = c.k_t * root(square > least ? square : least);
  const LaneMask<Real> sliding = stretched > limit;
  spring = (sliding ? limit / stretched : all_lanes<Real>(1.0)) * spring;
  const Lanes<Real> dashpot = sliding ? all_lanes<Real>(0.0) : c.eta_t;
  return -c.k_t * spring - dashpot * velocity;
}

template <class Real>
struct LargestOverlaps {
  Lanes<Real> overlap = {}, relative = {};

  GASGRAIN_LANES_INLINE void note(const Geometry<Real>& g) {
    overlap = g.overlap > overlap ? g.overlap : overlap;
    const LaneMask<Real> record = g.overlap > relative * g.radii;
    if (any(record)) relative = record ? g.overlap / g.radii : relative;
  }
};

// Force and moment of the pair `lane` as a LoadRecord holds them.
template <class Real>
GASGRAIN_LANES_INLINE Lanes<double> load_of(const FourLanes<Real>& forces,
                                            const FourLanes<Real>& torques, int lane) {
  const Lanes<Real> force = row_pair(forces, lane), torque = row_pair(torques, lane);
  const Lanes<Real> load = lane < 4
                               ? __builtin_shufflevector(force, torque, 0, 1, 2, 3, 8, 9, 10, 11)
                               : __builtin_shufflevector(force, torque, 4, 5, 6, 7, 12, 13, 14, 15);
  return __builtin_convertvector(load, Lanes<double>);
}

GASGRAIN_LANES_INLINE Lanes<double>& lanes_of(LoadRecord& record) {
  return *reinterpret_cast<Lanes<double>*>(record.force);
}

// Adds `force`, the same in both grains but for its sign, and the moment times the levers.
template <class Real, bool uniform>
GASGRAIN_LANES_INLINE void add_loads(const LoadRing& ring, const int* first, const int* second,
                                     const Vector<Real>& force, const Vector<Real>& torque_i,
                                     const Vector<Real>& torque_j) {
  const Lanes<Real> zero = {};
  const FourLanes<Real> forces = transposed<Real>({force.x, force.y, force.z, zero});
  const FourLanes<Real> torques_i = transposed<Real>({torque_i.x, torque_i.y, torque_i.z, zero});
  FourLanes<Real> torques_j = torques_i;
  if constexpr (!uniform) torques_j = transposed<Real>({torque_j.x, torque_j.y, torque_j.z, zero});
  const Lanes<double> reaction = {-1, -1, -1, -1, 1, 1, 1, 1};
#pragma GCC unroll 8
  for (int lane = 0; lane < group_size; ++lane) {
    LoadRecord& i = ring.slots[first[lane] & ring.mask];
    LoadRecord& j =
        ring.slots[second[lane] < ring.local_count ? second[lane] & ring.mask : ring.discarded];
    lanes_of(i) += load_of(forces, torques_i, lane);
    lanes_of(j) += reaction * load_of(forces, torques_j, lane);
  }
}

template <class Real, NormalModel normal, TangentialModel model, bool uniform>
GASGRAIN_LANES_INLINE void loads_of_group(const ContactBatch& batch, SpringRecord<Real>* springs,
                                          const int* places, LaneMask<Real> valid,
                                          const Coefficients<Real>& common,
                                          LargestOverlaps<Real>& largest) {
  alignas(32) int first[group_size], second[group_size];
  for (int lane = 0; lane < group_size; ++lane) {
    first[lane] = batch.first[places[lane]];
    second[lane] = batch.second[places[lane]];
  }
  Geometry<Real> g = geometry_of<Real>(separation(batch.grains, first, second));
  g.overlap = valid ? g.overlap : all_lanes<Real>(0.0);
  largest.note(g);
  const Vector<Real> n = g.n;

  const Vector<Real> v =
      vector_of(columns<Real>(rows<double>(batch.grains, first, velocity_quad) -
                              rows<double>(batch.grains, second, velocity_quad)));
  const FourLanes<double> spin_i = rows<double>(batch.spins, first, 0);
  const FourLanes<double> spin_j = rows<double>(batch.spins, second, 0);
  const Lanes<Real> half = all_lanes<Real>(0.5);
  Lanes<Real> lever_i = half * (g.radii - g.overlap), lever_j = lever_i;
  Vector<Real> spin;
  if constexpr (uniform) {
    spin = lever_i * vector_of(columns<Real>(spin_i + spin_j));
  } else {
    const Lanes<Real> radius_i = radii_of<Real>(batch.grains, first);
    lever_i = radius_i - half * g.overlap;
    lever_j = (g.radii - radius_i) - half * g.overlap;
    spin = lever_i * vector_of(columns<Real>(spin_i)) + lever_j * vector_of(columns<Real>(spin_j));
  }
  const Lanes<Real> v_n = dot(v, n);
  const Vector<Real> v_t = (v - v_n * n) + cross(n, spin);

  Coefficients<Real> c = uniform ? common : gather_coefficients<Real>(batch.coefficients, places);
  if constexpr (normal == NormalModel::hertz) c = stiffened(c, g.overlap);
  const Lanes<Real> force_n = c.k * g.overlap - c.eta * v_n;
  const Lanes<Real> least = all_lanes<Real>(batch.least_normal_force);
  const Lanes<Real> f_n = force_n > least ? force_n : least;
  Vector<Real> force = f_n * n;
  Vector<Real> moment = {};
  if constexpr (model != TangentialModel::off) {
    Vector<Real> spring = {};
    if constexpr (model == TangentialModel::history) spring = springs_of(springs, places);
    const Vector<Real> f_t = tangential_force<Real, model>(c, f_n, n, v_t, batch.slip_time, spring);
    force = force + f_t;
    moment = cross(f_t, n);
    if constexpr (model == TangentialModel::history) {
      const FourLanes<Real> stretched =
          transposed<Real>({spring.x, spring.y, spring.z, Lanes<Real>{}});
#pragma GCC unroll 8
      for (int lane = 0; lane < group_size; ++lane) {
        const Lanes<Real> pair = row_pair(stretched, lane);
        store_three(springs[places[lane]].displacement,
                    lane < 4 ? low_half(pair) : high_half(pair));
      }
    }
  }
  add_loads<Real, uniform>(batch.ring, first, second, force, lever_i * moment, lever_j * moment);
}

template <class Real>
GASGRAIN_LANES_INLINE double largest_lane(Lanes<Real> a, double start) {
  for (int lane = 0; lane < group_size; ++lane) start = a[lane] > start ? a[lane] : start;
  return start;
}

template <class Real, NormalModel normal, TangentialModel model, bool uniform>
void loads(ContactBatch& batch, SpringRecord<Real>* springs) {
  for (int lane = 0; lane < group_size; ++lane) batch.contacts[batch.count + lane] = batch.dummy;
  const Coefficients<Real> common = coefficients_of<Real>(batch.coefficients[0]);
  const LaneMask<Real> lanes = {0, 1, 2, 3, 4, 5, 6, 7};
  LargestOverlaps<Real> largest;
  for (int c = 0; c < batch.count; c += group_size) {
    ask_for_contacts(batch, springs, c + contact_groups_ahead * group_size);
    loads_of_group<Real, normal, model, uniform>(batch, springs, batch.contacts + c,
                                                 lanes < batch.count - c, common, largest);
  }
  batch.largest[0] = largest_lane<Real>(largest.overlap, batch.largest[0]);
  batch.largest[1] = largest_lane<Real>(largest.relative, batch.largest[1]);
}

template <class Real, NormalModel normal, TangentialModel model>
void loads_of_models(ContactBatch& batch, SpringRecord<Real>* springs, bool uniform) {
  if (uniform)
    loads<Real, normal, model, true>(batch, springs);
  else
    loads<Real, normal, model, false>(batch, springs);
}

template <class Real, NormalModel normal>
void loads_of_normal_model(ContactBatch& batch, SpringRecord<Real>* springs, TangentialModel model,
                           bool uniform) {
  switch (model) {
    case TangentialModel::off:
      return loads_of_models<Real, normal, TangentialModel::off>(batch, springs, uniform);
    case TangentialModel::no_history:
      return loads_of_models<Real, normal, TangentialModel::no_history>(batch, springs, uniform);
    case TangentialModel::history:
      return loads_of_models<Real, normal, TangentialModel::history>(batch, springs, uniform);
  }
}

template <class Real>
void contact_loads(ContactBatch& batch, SpringRecord<Real>* springs, const PairModel& model,
                   bool uniform) {
  switch (model.normal) {
    case NormalModel::linear:
      return loads_of_normal_model<Real, NormalModel::linear>(batch, springs, model.tangential,
                                                              uniform);
    case NormalModel::hertz:
      return loads_of_normal_model<Real, NormalModel::hertz>(batch, springs, model.tangential,
                                                             uniform);
  }
}

}  // namespace
}  // namespace gasgrain::plugins
