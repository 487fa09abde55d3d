// The neighbour lists of the fused engine and the memory of its contacts.
//
// Candidates: LIGGGHTS's list, valid until the next reneighbouring. Near pairs: those of them whose
// surfaces are nearer than a small margin, chosen anew whenever grains may have moved by half of
// it; only these are tested in a step. Every near pair has a tangential spring, which is zero
// unless the pair touched in the last step.
#pragma once

#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "liggghts_plugins/engine/kernel.hpp"

namespace gasgrain::plugins {

struct PairCounts {
  std::size_t candidates = 0;
  std::size_t touching = 0;
};

class ContactList {
 public:
  // Starts an empty list of candidates for grains 0 .. local_count - 1. Then, for every grain in
  // order: add_touching() for those partners it touches, in the order of candidates, and
  // add_row(). Partners have larger indices.
  // `dummy` and dummy + 1 are indices of two grains that never touch. Room is
  // made for that many pairs.
  void start(int local_count, int dummy, PairCounts room = {},
             Precision precision = Precision::full);
  void add_touching(int candidate, const double* spring);
  // Number of the first candidate of the next row.
  int next_candidate() const { return row_begin_.back(); }
  // `second`: the partners of the next grain; not copied, to be kept until the list is started
  // anew.
  void add_row(std::span<const int> second);

  int row_begin(int grain) const { return row_begin_[grain]; }
  int row_end(int grain) const { return row_begin_[grain + 1]; }
  // Largest index difference of two local grains of a pair.
  int widest_pair() const { return widest_pair_; }

  // Chooses the near pairs. Springs of touching pairs are kept. `coefficients(i, j)` is asked for
  // every near pair unless `uniform`.
  template <class Coefficients>
  void choose_near_pairs(const GrainRecord* grains, double margin, bool uniform,
                         Coefficients coefficients) {
    keep_touching();
    find_near_pairs(grains, margin);
    coefficients_.resize(uniform ? 1 : near_first_.size());
    for (std::size_t p = 0; p < coefficients_.size(); ++p)
      coefficients_[p] = coefficients(near_first_[p], near_second_[p]);
    restore_touching();
  }

  // Calls visit(candidate, spring) for the touching pairs in the order of candidates; `spring`:
  // three values in m. After choose_near_pairs().
  template <class Visit>
  void visit_touching(Visit visit) const {
    std::visit(
        [&](const auto& springs) {
          for_touching([&](std::size_t p) {
            const auto& s = springs[p].displacement;
            const double spring[3] = {s[0], s[1], s[2]};
            visit(near_candidate_[p], spring);
          });
        },
        springs_);
  }

  int block_count() const { return static_cast<int>(near_begin_.size()) - 1; }
  // Finds the contacts of a block's grains and adds their loads. `uniform`: all grains are alike.
  void add_contact_loads(int block, ContactBatch batch, const PairModel& model, bool uniform);

 private:
  template <class Real>
  using Springs = std::vector<SpringRecord<Real>>;

  // Calls visit(p) for the near pairs that touch, in their order.
  template <class Visit>
  void for_touching(Visit visit) const {
    for (std::size_t group = 0; group < touched_.size(); ++group)
      for (unsigned set = touched_[group]; set; set &= set - 1u)
        visit(group * group_size + __builtin_ctz(set));
  }

  void keep_touching();
  template <class Real>
  void gather_springs(Springs<Real>& springs);
  std::size_t most_near_pairs(std::size_t candidates) const;
  void find_near_pairs(const GrainRecord* grains, double margin);
  void pad_to_group();
  void list_candidates(int block);
  void restore_touching();
  template <class Real>
  void spread_springs(Springs<Real>& springs);

  int local_count_ = 0;
  int dummy_ = 0;
  int widest_pair_ = 0;
  std::vector<int> row_begin_;                   // per grain, and the end
  std::vector<const int*> partners_;             // per grain
  std::vector<int> block_first_, block_second_;  // candidates of one block

  std::vector<int> near_begin_;  // per block, and the end
  std::vector<int> near_first_, near_second_, near_candidate_;
  std::vector<unsigned char> touched_;  // a bit per near pair
  // Of near pairs; while these are chosen anew, of the candidates in touching_.
  std::variant<Springs<double>, Springs<float>> springs_;
  std::vector<int> touching_;
  std::vector<PairCoefficients> coefficients_;

  std::vector<int> places_;
};

}  // namespace gasgrain::plugins
