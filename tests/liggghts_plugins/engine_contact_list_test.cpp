// The engine's lists and kernels below LIGGGHTS: near pairs, memory of contacts, loads in a ring.
#include "liggghts_plugins/engine/contact_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/sphere_contact.hpp"

namespace gasgrain::plugins {
namespace {

constexpr PairCoefficients law = {
    .k = 1000, .eta = 0.02, .k_t = 700, .eta_t = 0.01, .mu = 0.3, .unused = {}};

struct CrowdOptions {
  double radius_spread = 0.1;  // m; 0: grains are alike
  Precision precision = Precision::full;
};

// A crowd of overlapping and separate spheres; all pairs are candidates.
struct Crowd {
  explicit Crowd(int count, double side, CrowdOptions options = {})
      : uniform(options.radius_spread == 0.0) {
    std::mt19937 numbers(3);
    std::uniform_real_distribution<double> place(0.0, side), speed(-1.0, 1.0);
    for (int i = 0; i < count; ++i) {
      grains.push_back({{place(numbers), place(numbers), place(numbers)},
                        0.5 + options.radius_spread * speed(numbers),
                        {speed(numbers), speed(numbers), speed(numbers)},
                        1.0});
      spins.push_back({{speed(numbers), speed(numbers), speed(numbers)}, 1.0});
    }
    for (double x : {1e3, 2e3}) {
      grains.push_back({{x, 0, 0}, 0.0, {0, 0, 0}, 1.0});
      spins.push_back({{0, 0, 0}, 1.0});
    }
    list.start(count, count, {}, options.precision);
    for (int i = 0; i < count; ++i) indices.push_back(i);
    for (int i = 0; i < count; ++i) list.add_row(std::span(indices).subspan(i + 1));
    int size = 1;
    while (size < grains_per_block + list.widest_pair() + 1) size *= 2;
    loads.resize(size + 1);
    ring = {loads.data(), size - 1, size, count};
  }

  int count() const { return static_cast<int>(grains.size()) - 2; }
  void choose(double margin) {
    list.choose_near_pairs(grains.data(), margin, uniform, [](int, int) { return law; });
  }
  void add_loads(TangentialModel tangential, double slip_time) {
    const PairModel model{.normal = NormalModel::linear,
                          .tangential = tangential,
                          .least_normal_force = -std::numeric_limits<double>::infinity()};
    for (int block = 0; block < list.block_count(); ++block)
      list.add_contact_loads(block,
                             {.grains = grains.data(),
                              .spins = spins.data(),
                              .first = nullptr,
                              .second = nullptr,
                              .coefficients = nullptr,
                              .ring = ring,
                              .contacts = nullptr,
                              .count = 0,
                              .dummy = 0,
                              .slip_time = slip_time,
                              .least_normal_force = model.least_normal_force,
                              .largest = largest},
                             model, uniform);
  }
  double gap(int i, int j) const {
    return (position(i) - position(j)).norm() - grains[i].radius - grains[j].radius;
  }
  struct TouchingPair {
    int candidate;
    Vec3 spring;
  };
  std::vector<TouchingPair> touching() const {
    std::vector<TouchingPair> pairs;
    list.visit_touching([&](int candidate, const double* spring) {
      pairs.push_back({candidate, Vec3(spring)});
    });
    return pairs;
  }
  Vec3 position(int i) const { return Vec3(grains[i].position); }

  bool uniform;
  std::vector<GrainRecord> grains;
  std::vector<SpinRecord> spins;
  std::vector<int> indices;
  ContactList list;
  std::vector<LoadRecord> loads;
  LoadRing ring{};
  double largest[2] = {0, 0};
};

TEST(ContactList, remembers_exactly_the_touching_pairs) {
  Crowd crowd(300, 6.0);
  crowd.choose(0.2);
  crowd.add_loads(TangentialModel::history, 1e-3);
  std::set<int> expected;
  int place = 0;
  for (int i = 0; i < crowd.count(); ++i)
    for (int j = i + 1; j < crowd.count(); ++j, ++place)
      if (crowd.gap(i, j) < 0) expected.insert(place);
  std::set<int> found;
  for (const Crowd::TouchingPair& pair : crowd.touching()) found.insert(pair.candidate);
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(found, expected);
}

TEST(ContactList, keeps_springs_when_near_pairs_are_chosen_anew) {
  Crowd crowd(300, 6.0);
  crowd.choose(0.2);
  crowd.add_loads(TangentialModel::history, 1e-3);
  const std::vector<Crowd::TouchingPair> before = crowd.touching();
  crowd.add_loads(TangentialModel::history, 0.0);  // does not advance
  crowd.choose(0.01);
  const std::vector<Crowd::TouchingPair> after = crowd.touching();
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t n = 0; n < before.size(); ++n) {
    EXPECT_EQ(after[n].candidate, before[n].candidate);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(after[n].spring[d], before[n].spring[d], 1e-15);
  }
}

TEST(ContactList, forgets_a_pair_that_parts) {
  Crowd crowd(2, 0.1);
  crowd.choose(0.5);
  crowd.add_loads(TangentialModel::history, 1e-3);
  ASSERT_EQ(crowd.touching().size(), 1u);
  EXPECT_NE(crowd.touching()[0].spring[0], 0.0);
  const double touching_at = crowd.grains[1].position[2];
  crowd.grains[1].position[2] += 1.4;
  crowd.add_loads(TangentialModel::history, 1e-3);
  EXPECT_TRUE(crowd.touching().empty());
  crowd.grains[1].position[2] = touching_at;
  crowd.add_loads(TangentialModel::history, 0.0);
  ASSERT_EQ(crowd.touching().size(), 1u);
  for (int d = 0; d < 3; ++d) EXPECT_EQ(crowd.touching()[0].spring[d], 0.0);
}

// The same contact by the scalar law that the stock path uses.
void add_reference(std::vector<Vec3>& force, std::vector<Vec3>& torque, const Crowd& crowd, int i,
                   int j, double slip_time) {
  const GrainRecord &a = crowd.grains[i], &b = crowd.grains[j];
  const Vec3 delta = crowd.position(i) - crowd.position(j);
  const double overlap = a.radius + b.radius - delta.norm();
  const Vec3 n = delta.normalized();
  const double lever_i = a.radius - 0.5 * overlap, lever_j = b.radius - 0.5 * overlap;
  const ContactState state{.n = n,
                           .overlap = overlap,
                           .relative_velocity = Vec3(a.velocity) - Vec3(b.velocity),
                           .lever_spin = lever_i * Vec3(crowd.spins[i].velocity) +
                                         lever_j * Vec3(crowd.spins[j].velocity)};
  Vec3 spring = Vec3::Zero();
  const ContactForce on_i = contact_force<TangentialModel::history>(
      {law.k, law.eta, law.k_t, law.eta_t, law.mu}, state, spring, {History::advance, slip_time});
  force[i] += on_i.force;
  force[j] -= on_i.force;
  torque[i] += lever_i * on_i.moment;
  torque[j] += lever_j * on_i.moment;
}

// Largest difference of the kernel's loads from the scalar law, and of its largest overlap. One
// block, so that no slot of the ring is used twice; slip large enough for some to slide.
struct Difference {
  double load = 0, overlap = 0;
};
Difference from_scalar_law(const CrowdOptions& options) {
  Crowd crowd(grains_per_block, 6.0, options);
  const double slip_time = 0.05;
  crowd.choose(0.1);
  crowd.add_loads(TangentialModel::history, slip_time);
  std::vector<Vec3> force(crowd.count(), Vec3::Zero()), torque = force;
  double overlap = 0;
  for (int i = 0; i < crowd.count(); ++i)
    for (int j = i + 1; j < crowd.count(); ++j)
      if (crowd.gap(i, j) < 0) {
        add_reference(force, torque, crowd, i, j, slip_time);
        overlap = std::max(overlap, -crowd.gap(i, j));
      }
  Difference largest{0, std::abs(crowd.largest[0] - overlap)};
  for (int i = 0; i < crowd.count(); ++i)
    largest.load = std::max({largest.load, (Vec3(crowd.loads[i].force) - force[i]).norm(),
                             (Vec3(crowd.loads[i].torque) - torque[i]).norm()});
  return largest;
}

// Those that this processor can run, one after the other; every one can run the generic kernel.
template <class Check>
void with_every_kernel(Check check) {
  for (const std::string name : {"generic", "avx2", "avx512"}) {
    try {
      choose_contact_kernel(name);
    } catch (const UserError& error) {
      EXPECT_NE(name, "generic") << error.what();
      continue;
    }
    SCOPED_TRACE(name);
    check();
  }
}

TEST(ContactKernel, adds_the_loads_of_the_contact_law) {
  with_every_kernel([] {
    for (const double spread : {0.0, 0.1}) {
      const Difference full = from_scalar_law({spread, Precision::full});
      EXPECT_LT(full.load, 1e-10) << spread;
      EXPECT_LT(full.overlap, 1e-14) << spread;
    }
  });
}

TEST(ContactKernel, mixed_precision_is_that_of_float) {
  with_every_kernel([] {
    for (const double spread : {0.0, 0.1}) {
      // loads of a crowd are sums of about ten forces of some hundred N
      const Difference mixed = from_scalar_law({spread, Precision::mixed});
      EXPECT_LT(mixed.load, 1e-3) << spread;
      EXPECT_LT(mixed.overlap, 1e-7) << spread;
      EXPECT_GT(mixed.load, 1e-7) << spread << ": not in single precision";
    }
  });
}

TEST(ContactKernel, a_slight_overlap_keeps_its_digits_in_mixed_precision) {
  const double overlap = 1e-6;  // of a radius of 0.5
  Crowd crowd(2, 1.0, {0.0, Precision::mixed});
  for (int d = 0; d < 3; ++d)
    crowd.grains[1].position[d] = crowd.grains[0].position[d] + (1.0 - overlap) / std::sqrt(3.0);
  for (int i : {0, 1}) crowd.grains[i].velocity[0] = crowd.grains[i].velocity[1] = 0.0;
  for (int i : {0, 1}) crowd.grains[i].velocity[2] = 0.0;
  crowd.choose(0.1);
  crowd.add_loads(TangentialModel::off, 0.0);
  EXPECT_NEAR(Vec3(crowd.loads[0].force).norm(), law.k * overlap, 1e-6 * law.k * overlap);
}

TEST(ContactKernel, mixed_precision_conserves_momentum_to_round_off_of_double) {
  with_every_kernel([] {
    for (const double spread : {0.0, 0.1}) {
      Crowd crowd(grains_per_block, 6.0, {spread, Precision::mixed});
      crowd.choose(0.1);
      crowd.add_loads(TangentialModel::history, 0.05);
      Vec3 sum = Vec3::Zero();
      double turnover = 0;
      for (int i = 0; i < crowd.count(); ++i) {
        sum += Vec3(crowd.loads[i].force);
        turnover += Vec3(crowd.loads[i].force).norm();
      }
      EXPECT_GT(turnover, 1e3);
      EXPECT_LT(sum.norm(), 1e-14 * turnover) << spread;
    }
  });
}

TEST(ContactKernel, integrates_as_velocity_verlet) {
  Crowd crowd(3, 1.0);
  const GrainRecord before = crowd.grains[1];
  crowd.loads[1] = {{1, 2, 3, 0}, {4, 5, 6, 0}};
  const double held[9] = {0, 0, 0, 0.5, -0.5, 0.25, 0, 0, 0};
  IntegrationBatch batch{.grains = crowd.grains.data(),
                         .spins = crowd.spins.data(),
                         .ring = crowd.ring,
                         .held_forces = held,
                         .drag = nullptr,
                         .fixed = nullptr,
                         .begin = 0,
                         .end = 3,
                         .gravity = {0, 0, -9.81},
                         .kick = 0.1,
                         .drift = 0.2,
                         .square_speed = 0.0,
                         .gas_force = {0.0, 0.0, 0.0}};
  const Vec3 spin = Vec3(crowd.spins[1].velocity) + 0.1 * Vec3(4, 5, 6);
  const Vec3 velocity = Vec3(before.velocity) + 0.1 * (Vec3(1.5, 1.5, 3.25) + Vec3(0, 0, -9.81));
  contact_kernel().integrate(batch);
  const GrainRecord& after = crowd.grains[1];
  EXPECT_LT((Vec3(after.velocity) - velocity).norm(), 1e-14);
  EXPECT_LT((Vec3(after.position) - Vec3(before.position) - 0.2 * velocity).norm(), 1e-14);
  EXPECT_LT((Vec3(crowd.spins[1].velocity) - spin).norm(), 1e-14);
  EXPECT_EQ(after.radius, before.radius);
  EXPECT_EQ(after.inverse_mass, before.inverse_mass);
  EXPECT_EQ(Vec3(crowd.loads[1].force).norm(), 0.0);
  double fastest = 0;
  for (int i = 0; i < 3; ++i)
    fastest = std::max(fastest, Vec3(crowd.grains[i].velocity).squaredNorm());
  EXPECT_NEAR(batch.square_speed, fastest, 1e-14);
}

}  // namespace
}  // namespace gasgrain::plugins
