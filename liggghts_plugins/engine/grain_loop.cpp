#include "liggghts_plugins/engine/grain_loop.hpp"

#include <algorithm>
#include <cmath>

namespace gasgrain::plugins {

namespace {

// Margin of near pairs as a share of the skin. Smaller: fewer tests per step, more frequent choice.
constexpr double near_share = 0.3;

}  // namespace

void GrainLoop::start(GrainCounts counts, const PairLaw& law, PairCounts room,
                      Precision precision) {
  counts_ = counts;
  law_ = &law;
  const int size = counts.total() + 2;
  grains_.resize(size);
  spins_.resize(size);
  members_.clear();
  if (counts.total() == 0) members_.push_back({.type = 1, .mass = 1, .radius = 1, .frozen = false});
  fixed_.resize(size);
  some_fixed_ = false;
  const double places[2][3] = {{0, 0, 0}, {1, 0, 0}}, at_rest[3] = {0, 0, 0};
  // padding: points that never touch
  const PairMember point{.type = 1, .mass = 1.0, .radius = 0.0, .frozen = false};
  for (int n = counts.total(); n < size; ++n)
    set_grain(n, {places[n - counts.total()], at_rest, at_rest, point, false});
  pairs_.start(counts.local, counts.total(), room, precision);
}

void GrainLoop::set_grain(int i, const GrainState& state) {
  GrainRecord& grain = grains_[i];
  SpinRecord& spin = spins_[i];
  for (int d = 0; d < 3; ++d) {
    grain.position[d] = state.position[d];
    grain.velocity[d] = state.velocity[d];
    spin.velocity[d] = state.spin[d];
  }
  constexpr double sphere = 0.4;  // moment of inertia / (m r^2)
  const double mass = state.contact.mass, radius = state.contact.radius;
  grain.radius = radius;
  grain.inverse_mass = 1.0 / mass;
  spin.inverse_inertia = radius > 0 ? 1.0 / (sphere * mass * radius * radius) : 0.0;
  if (i < counts_.total()) note_member(i, state.contact);
  fixed_[i] = state.fixed ? 1 : 0;
  some_fixed_ = some_fixed_ || state.fixed;
}

void GrainLoop::note_member(int i, const PairMember& member) {
  if (members_.empty()) members_.push_back(member);
  if (uniform() && members_[0] != member) members_.resize(grains_.size(), members_[0]);
  if (!uniform()) members_[i] = member;
}

// Slots in use at a time: those of the block and as far as its pairs reach.
void GrainLoop::size_ring() {
  int size = 1;
  while (size < grains_per_block + pairs_.widest_pair() + 1) size *= 2;
  loads_.assign(size + 1, LoadRecord{});
  ring_ = {
      .slots = loads_.data(), .mask = size - 1, .discarded = size, .local_count = counts_.local};
}

void GrainLoop::finish_loading(double skin) {
  size_ring();
  near_margin_ = near_share * skin;
  travelled_ = 0.0;
  choose_near_pairs();
  for (WallContacts& wall : walls_) wall.load(counts_.local);
}

void GrainLoop::choose_near_pairs() {
  pairs_.choose_near_pairs(grains_.data(), near_margin_, uniform(),
                           [this](int i, int j) { return law_->between(member(i), member(j)); });
  near_travelled_ = 0.0;
}

void GrainLoop::note_travel(double distance) {
  travelled_ += distance;
  near_travelled_ += distance;
}

// Of grains before `end`.
void GrainLoop::add_outside_loads(int end) {
  for (std::size_t list = 0; list < outside_loads_.size(); ++list) {
    const std::vector<GrainLoad>& loads = outside_loads_[list];
    std::size_t& n = outside_done_[list];
    for (; n < loads.size() && loads[n].grain < end; ++n) {
      LoadRecord& sum = loads_[loads[n].grain & ring_.mask];
      Eigen::Map<Vec3>(sum.force) += loads[n].force;
      Eigen::Map<Vec3>(sum.torque) += loads[n].torque;
    }
  }
}

void GrainLoop::force_pass(const PassSettings& settings, const Observer* observer) {
  if (2.0 * near_travelled_ > near_margin_) choose_near_pairs();
  largest_[0] = largest_[1] = 0.0;
  const PairModel model = law_->model();
  const ContactBatch contacts{.grains = grains_.data(),
                              .spins = spins_.data(),
                              .first = nullptr,
                              .second = nullptr,
                              .coefficients = nullptr,
                              .ring = ring_,
                              .contacts = nullptr,
                              .count = 0,
                              .dummy = 0,
                              .slip_time = settings.slip.duration,
                              .least_normal_force = model.least_normal_force,
                              .largest = largest_};
  const WallBatch wall_batch{.grains = grains_.data(),
                             .spins = spins_.data(),
                             .ring = ring_,
                             .step = settings.slip,
                             .travelled = travelled_};
  IntegrationBatch integration{
      .grains = grains_.data(),
      .spins = spins_.data(),
      .ring = ring_,
      .held_forces = settings.held.constant ? settings.held.constant->data() : nullptr,
      .drag = settings.held.coefficients,
      .fixed = some_fixed_ ? fixed_.data() : nullptr,
      .begin = 0,
      .end = 0,
      .gravity = {settings.gravity[0], settings.gravity[1], settings.gravity[2]},
      .kick = settings.kick,
      .drift = settings.drift,
      .square_speed = 0.0,
      .gas_force = {0.0, 0.0, 0.0}};

  for (WallContacts& wall : walls_) wall.begin_step();
  outside_done_.assign(outside_loads_.size(), 0);
  for (int block = 0; block < pairs_.block_count(); ++block) {
    integration.begin = block * grains_per_block;
    integration.end = std::min(counts_.local, integration.begin + grains_per_block);
    pairs_.add_contact_loads(block, contacts, model, uniform());
    for (WallContacts& wall : walls_) wall.add_contact_loads(block, wall_batch);
    add_outside_loads(integration.end);
    if (observer)
      for (int i = integration.begin; i < integration.end; ++i)
        (*observer)(i, loads_[i & ring_.mask]);
    contact_kernel().integrate(integration);
  }
  loads_[ring_.discarded] = {};
  for (const WallContacts& wall : walls_) wall.end_step();
  square_speed_ = integration.square_speed;
  held_force_sum_ = Eigen::Map<const Vec3>(integration.gas_force);
}

}  // namespace gasgrain::plugins
