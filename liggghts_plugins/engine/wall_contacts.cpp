#include "liggghts_plugins/engine/wall_contacts.hpp"

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

}  // namespace

void WallContacts::load(int local_count) {
  candidates_.clear();
  block_begin_.clear();
  swept_ = 0.0;
  for (const int i : wall_->candidates()) {
    while (static_cast<int>(block_begin_.size()) * grains_per_block <= i)
      block_begin_.push_back(static_cast<int>(candidates_.size()));
    candidates_.push_back({i, wall_->tag(i), wall_->type(i), 0.0});
  }
  const int blocks = (local_count + grains_per_block - 1) / grains_per_block;
  block_begin_.resize(blocks + 1, static_cast<int>(candidates_.size()));
}

void WallContacts::begin_step() {
  load_ = {};
  wall_->place_wall();
  swept_ += wall_->fastest_sweep() * wall_->step_duration();
}

void WallContacts::add_contact_loads(int block, const WallBatch& batch) {
  switch (wall_->tangential()) {
    case TangentialModel::off:
      return add_block<TangentialModel::off>(block, batch);
    case TangentialModel::no_history:
      return add_block<TangentialModel::no_history>(block, batch);
    case TangentialModel::history:
      return add_block<TangentialModel::history>(block, batch);
  }
}

template <TangentialModel tangential>
void WallContacts::add_block(int block, const WallBatch& batch) {
  SdfWall& wall = wall_->wall();
  std::vector<Vec3>& springs = wall_->springs();
  const double travelled = batch.travelled + swept_;
  for (int c = block_begin_[block]; c < block_begin_[block + 1]; ++c) {
    // runs of a block are too short for the processor to foresee them; the next block's follow
    constexpr int ahead = 8;
    __builtin_prefetch(candidates_.data() + c + ahead, 1);
    __builtin_prefetch(springs.data() + c + ahead, 1);
    Candidate& candidate = candidates_[c];
    if (travelled < candidate.touches_after) continue;
    const int i = candidate.grain;
    const GrainRecord& record = batch.grains[i];
    const GrainAtWall grain{.tag = candidate.tag,
                            .type = candidate.type,
                            .radius = record.radius,
                            .mass = 1.0 / record.inverse_mass,
                            .position = ConstColumn(record.position),
                            .velocity = ConstColumn(record.velocity),
                            .spin = ConstColumn(batch.spins[i].velocity)};
    const WallTouch touch =
        wall.touch<tangential>(grain, wall_->local_walls(c), springs[c], batch.step, load_);
    if (touch.touches) {
      LoadRecord& sum = batch.ring.slots[i & batch.ring.mask];
      Column(sum.force) += touch.force;
      Column(sum.torque) += touch.torque;
    } else {
      candidate.touches_after = travelled + touch.way;
    }
  }
}

}  // namespace gasgrain::plugins
