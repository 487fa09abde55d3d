#include "liggghts_plugins/engine/pair_law.hpp"

#include <limits>

#include "liggghts_plugins/pair_gran_cgm.hpp"

namespace gasgrain::plugins {

namespace {

class CgmLaw : public PairLaw {
 public:
  explicit CgmLaw(const PairGranCgm& pair) : pair_(pair) {}

  PairModel model() const override {
    return {.normal = NormalModel::linear,
            .tangential = pair_.tangential(),
            .least_normal_force = -std::numeric_limits<double>::infinity()};
  }
  int history_offset() const override { return pair_.history_offset(); }
  std::string name() const override { return "cgm"; }

  PairCoefficients between(const PairMember& first, const PairMember& second) const override {
    const GrainContact& contact = pair_.contacts()(first.type, second.type);
    const ContactCoefficients c = second.frozen  ? contact.first_against_fixed(first.mass)
                                  : first.frozen ? contact.second_against_fixed(second.mass)
                                                 : contact.between(first.mass, second.mass);
    return {.k = c.spring_constant,
            .eta = c.damping_coefficient,
            .k_t = c.tangential_spring_constant,
            .eta_t = c.tangential_damping,
            .mu = c.friction_coefficient,
            .unused = {}};
  }

 private:
  const PairGranCgm& pair_;
};

}  // namespace

std::unique_ptr<PairLaw> make_cgm_law(const PairGranCgm& pair) {
  return std::make_unique<CgmLaw>(pair);
}

}  // namespace gasgrain::plugins
