#include "liggghts_plugins/engine/contact_list.hpp"

#include <algorithm>

#include "coupling/shared/error.hpp"

namespace gasgrain::plugins {

namespace {

constexpr int no_candidate = -1;  // of padding

int blocks_of(int grains) {
  return (grains + grains_per_block - 1) / grains_per_block;
}

// Room for `count` entries and a few more, instead of up to twice as many: lists of all pairs are
// most of the engine's memory, and their lengths hardly change.
template <class Entry>
void make_room(std::vector<Entry>& entries, std::size_t count) {
  if (count > entries.capacity()) entries.reserve(count + count / 16);
}

}  // namespace

void ContactList::start(int local_count, int dummy, PairCounts room, Precision precision) {
  local_count_ = local_count;
  dummy_ = dummy;
  widest_pair_ = 0;
  row_begin_.assign(1, 0);
  make_room(row_begin_, local_count + 1);
  partners_.clear();
  make_room(partners_, local_count);
  near_begin_.assign(blocks_of(local_count) + 1, 0);
  near_first_.clear();
  near_second_.clear();
  near_candidate_.clear();
  touched_.clear();
  if (precision == Precision::full && !std::holds_alternative<Springs<double>>(springs_))
    springs_ = Springs<double>();
  if (precision == Precision::mixed && !std::holds_alternative<Springs<float>>(springs_))
    springs_ = Springs<float>();
  touching_.clear();
  // for all pairs that may become near: growing later would hold them twice for a moment, while
  // room that is not used is no memory
  std::visit(
      [&](auto& springs) {
        springs.clear();
        make_room(springs, most_near_pairs(room.candidates));
      },
      springs_);
  make_room(touching_, room.touching);
}

void ContactList::add_touching(int candidate, const double* spring) {
  GASGRAIN_ASSERT(touching_.empty() || touching_.back() < candidate);
  touching_.push_back(candidate);
  std::visit(
      [&]<class Real>(Springs<Real>& springs) {
        springs.push_back({{static_cast<Real>(spring[0]), static_cast<Real>(spring[1]),
                            static_cast<Real>(spring[2])}});
      },
      springs_);
}

void ContactList::add_row(std::span<const int> second) {
  const int grain = static_cast<int>(partners_.size());
  for (const int partner : second)
    if (partner < local_count_) widest_pair_ = std::max(widest_pair_, partner - grain);
  partners_.push_back(second.data());
  row_begin_.push_back(row_begin_.back() + static_cast<int>(second.size()));
}

// With the padding of each block and of the end.
std::size_t ContactList::most_near_pairs(std::size_t candidates) const {
  return candidates + (static_cast<std::size_t>(block_count()) + 1) * group_size;
}

void ContactList::find_near_pairs(const GrainRecord* grains, double margin) {
  const ContactKernel& kernel = contact_kernel();
  near_first_.clear();
  near_second_.clear();
  near_candidate_.clear();
  const std::size_t most = most_near_pairs(row_begin_.back());
  for (std::vector<int>* list : {&near_first_, &near_second_, &near_candidate_})
    make_room(*list, most);
  for (int block = 0; block < block_count(); ++block) {
    near_begin_[block] = static_cast<int>(near_first_.size());
    const int begin = row_begin_[block * grains_per_block];
    const int end = row_begin_[std::min(local_count_, (block + 1) * grains_per_block)];
    places_.resize(end - begin + 2 * group_size);
    list_candidates(block);
    const int count =
        kernel.near_pairs(grains, {block_first_.data(), block_second_.data(), 0, end - begin},
                          margin, places_.data());
    for (int n = 0; n < count; ++n) {
      near_first_.push_back(block_first_[places_[n]]);
      near_second_.push_back(block_second_[places_[n]]);
      near_candidate_.push_back(begin + places_[n]);
    }
    pad_to_group();
  }
  near_begin_.back() = static_cast<int>(near_first_.size());
  // one group of padding behind all blocks serves the contacts of incomplete groups
  near_first_.resize(near_first_.size() + group_size, dummy_);
  near_second_.resize(near_second_.size() + group_size, dummy_ + 1);
  near_candidate_.resize(near_candidate_.size() + group_size, no_candidate);
}

void ContactList::list_candidates(int block) {
  block_first_.clear();
  block_second_.clear();
  const int last = std::min(local_count_, (block + 1) * grains_per_block);
  for (int grain = block * grains_per_block; grain < last; ++grain) {
    const int count = row_end(grain) - row_begin(grain);
    block_first_.insert(block_first_.end(), count, grain);
    block_second_.insert(block_second_.end(), partners_[grain], partners_[grain] + count);
  }
  block_first_.insert(block_first_.end(), group_size, dummy_);
  block_second_.insert(block_second_.end(), group_size, dummy_ + 1);
}

void ContactList::pad_to_group() {
  while (near_first_.size() % group_size != 0) {
    near_first_.push_back(dummy_);
    near_second_.push_back(dummy_ + 1);
    near_candidate_.push_back(no_candidate);
  }
}

void ContactList::keep_touching() {
  if (touched_.empty()) return;  // they are there: the list has just been loaded
  std::visit([this](auto& springs) { gather_springs(springs); }, springs_);
}

// Springs of touching pairs move to the front.
template <class Real>
void ContactList::gather_springs(Springs<Real>& springs) {
  for_touching([&](std::size_t p) {
    springs[touching_.size()] = springs[p];
    touching_.push_back(near_candidate_[p]);
  });
  springs.resize(touching_.size());
}

void ContactList::restore_touching() {
  std::visit([this](auto& springs) { spread_springs(springs); }, springs_);
}

// And on to their places in the new list; a pair that is not near any more has parted since.
template <class Real>
void ContactList::spread_springs(Springs<Real>& springs) {
  touched_.assign(near_first_.size() / group_size, 0);
  std::size_t kept = 0, p = 0;
  for (std::size_t n = 0; n < touching_.size(); ++n) {
    while (p < near_candidate_.size() && near_candidate_[p] < touching_[n]) ++p;
    if (p == near_candidate_.size()) break;
    if (near_candidate_[p] != touching_[n]) continue;
    springs[kept] = springs[n];
    touching_[kept++] = static_cast<int>(p);
    touched_[p / group_size] |= static_cast<unsigned char>(1u << (p % group_size));
  }
  springs.resize(kept);
  make_room(springs, near_first_.size());
  springs.resize(near_first_.size());
  while (kept-- > 0) {  // from the end: places are never before those in front
    const int place = touching_[kept];
    if (place == static_cast<int>(kept)) continue;
    springs[place] = springs[kept];
    springs[kept] = {};
  }
  touching_.clear();
}

void ContactList::add_contact_loads(int block, ContactBatch batch, const PairModel& model,
                                    bool uniform) {
  const PairRange pairs{near_first_.data(), near_second_.data(), near_begin_[block],
                        near_begin_[block + 1]};
  places_.resize(pairs.end - pairs.begin + 2 * group_size);
  std::visit(
      [&]<class Real>(Springs<Real>& springs) {
        const ForceKernel<Real>& forces = force_kernel<Real>(contact_kernel());
        batch.count = forces.touching_pairs(batch.grains, pairs, touched_.data(), springs.data(),
                                            places_.data());
        if (batch.count == 0) return;
        batch.first = near_first_.data();
        batch.second = near_second_.data();
        batch.coefficients = coefficients_.data();
        batch.contacts = places_.data();
        batch.dummy = near_begin_.back();
        forces.contact_loads(batch, springs.data(), model, uniform);
      },
      springs_);
}

}  // namespace gasgrain::plugins
