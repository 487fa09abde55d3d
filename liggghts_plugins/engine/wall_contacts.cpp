#include "liggghts_plugins/engine/wall_contacts.hpp"

#include <algorithm>

namespace gasgrain::plugins {

namespace {

using Column = Eigen::Map<Vec3>;
using ConstColumn = Eigen::Map<const Vec3>;

constexpr double steepest_gradient = 1.7320508075688773;  // sqrt 3
constexpr double smallest_gradient = 1e-3;                // as in fix wall/sdf

}  // namespace

void WallContacts::load(int local_count) {
  grains_ = wall_->candidates();
  displacements_.resize(grains_.size());
  for (std::size_t c = 0; c < grains_.size(); ++c)
    displacements_[c] = wall_->displacements()[grains_[c]];
  touches_after_.assign(grains_.size(), 0.0);
  block_begin_.clear();
  for (int begin = 0; begin < local_count; begin += grains_per_block)
    block_begin_.push_back(static_cast<int>(
        std::lower_bound(grains_.begin(), grains_.end(), begin) - grains_.begin()));
  block_begin_.push_back(static_cast<int>(grains_.size()));
}

void WallContacts::store() const {
  for (std::size_t c = 0; c < grains_.size(); ++c)
    wall_->displacements()[grains_[c]] = displacements_[c];
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
  const SignedDistance& shape = *wall_->body().shape;
  for (int c = block_begin_[block]; c < block_begin_[block + 1]; ++c) {
    if (batch.travelled < touches_after_[c]) continue;
    const GrainRecord& grain = batch.grains[grains_[c]];
    const DistanceSample wall = shape.sample(ConstColumn(grain.position));
    if (wall.distance < grain.radius &&
        wall.gradient.squaredNorm() > smallest_gradient * smallest_gradient) {
      add_contact<tangential>(wall, c, batch);
    } else {
      displacements_[c].setZero();
      touches_after_[c] = batch.travelled + (wall.distance - grain.radius) / steepest_gradient;
    }
  }
}

template <TangentialModel tangential>
void WallContacts::add_contact(const DistanceSample& wall, int candidate, const WallBatch& batch) {
  const int i = grains_[candidate];
  const GrainRecord& grain = batch.grains[i];
  const double overlap = grain.radius - wall.distance;
  const double gradient = wall.gradient.norm();
  const Vec3 n = wall.gradient / gradient;
  const double lever = grain.radius - 0.5 * overlap;
  const ContactState state{
      .n = n,
      .overlap = gradient * overlap,
      .relative_velocity = ConstColumn(grain.velocity) - wall_->body().surface_velocity,
      .lever_spin = lever * ConstColumn(batch.spins[i].velocity)};
  const ContactCoefficients c = wall_->contacts()(batch.types[i], wall_->wall_type())
                                    .first_against_fixed(1.0 / grain.inverse_mass);
  const ContactForce f = contact_force<tangential>(c, state, displacements_[candidate], batch.step);
  LoadRecord& sum = batch.ring.slots[i & batch.ring.mask];
  Column(sum.force) += f.force;
  Column(sum.torque) += lever * f.moment;
  load_.add(f.force, ConstColumn(grain.position) - lever * n,
            {.length = overlap, .relative = overlap / (2.0 * grain.radius)});
}

}  // namespace gasgrain::plugins
