#include "liggghts_plugins/contact_properties.hpp"

#include <atom.h>
#include <fix_property_global.h>
#include <force.h>
#include <lammps.h>
#include <modify.h>

#include <cstring>
#include <optional>
#include <sstream>
#include <string>

#include "coupling/shared/config_table.hpp"
#include "coupling/shared/error.hpp"

namespace gasgrain::plugins {

namespace {

using LAMMPS_NS::FixPropertyGlobal;
using LAMMPS_NS::LAMMPS;

FixPropertyGlobal* find_pair_property(LAMMPS& lmp, const char* name, const char* where) {
  const int types = lmp.atom->ntypes;
  for (int i = 0; i < lmp.modify->nfix; ++i) {
    LAMMPS_NS::Fix* fix = lmp.modify->fix[i];
    if (std::strcmp(fix->style, "property/global") != 0) continue;
    auto* property = static_cast<FixPropertyGlobal*>(fix);
    if (property->check_fix(name, "peratomtypepair", types, types, where, false)) return property;
  }
  return nullptr;
}

// One property for all type pairs, checked on reading.
class PairProperty {
 public:
  PairProperty(LAMMPS& lmp, const char* name, const Range& allowed, const char* where)
      : name_(name),
        where_(where),
        allowed_(allowed),
        property_(find_pair_property(lmp, name, where)) {}

  void require(int types) const {
    if (property_) return;
    std::ostringstream message;
    message << where_ << ": missing property of the original particle; add `fix ID all "
            << "property/global " << name_ << " peratomtypepair " << types << " "
            << (types == 1 ? "VALUE" : "VALUE ...") << "`";
    throw UserError(message.str());
  }

  double value(int first_type, int second_type, double otherwise) const {
    if (!property_) return otherwise;
    const double value = property_->compute_array(first_type - 1, second_type - 1);
    if (!allowed_.contains(value))
      fail(first_type, second_type, value, "must be in " + allowed_.text());
    if (value != property_->compute_array(second_type - 1, first_type - 1))
      fail(first_type, second_type, value,
           "differs from the value of the exchanged types; state the same for both");
    return value;
  }

 private:
  [[noreturn]] void fail(int first, int second, double value, const std::string& why) const {
    std::ostringstream message;
    message << where_ << ": property/global " << name_ << " of types " << first << ", " << second
            << " = " << value << " " << why;
    throw UserError(message.str());
  }

  const char* name_;
  const char* where_;
  Range allowed_;
  FixPropertyGlobal* property_;
};

}  // namespace

GrainContactTable::GrainContactTable(LAMMPS& lmp, const ContactSettings& settings,
                                     const char* where) {
  const int types = lmp.atom->ntypes;
  const PairProperty spring(lmp, "cgmSpringConstant", Range::positive(), where);
  const PairProperty restitution(lmp, "coefficientRestitution",
                                 {.lower = 0, .upper = 1, .lower_open = true}, where);
  const PairProperty friction(lmp, "coefficientFriction", Range::non_negative(), where);
  const PairProperty stiffness_ratio(lmp, "cgmTangentialStiffnessRatio", Range::positive(), where);
  const PairProperty damping_ratio(lmp, "cgmTangentialDampingRatio", Range::non_negative(), where);
  const PairProperty adhesion(lmp, "cgmWorkOfAdhesion", Range::non_negative(), where);
  const PairProperty rolling(lmp, "cgmRollingFriction", Range::non_negative(), where);
  spring.require(types);
  restitution.require(types);
  if (settings.tangential != TangentialModel::off) friction.require(types);

  stride_ = types + 1;
  contacts_.resize(stride_ * stride_);
  for (int i = 1; i <= types; ++i) {
    for (int j = 1; j <= types; ++j) {
      const OriginalContact original{.spring_constant = spring.value(i, j, 0.0),
                                     .restitution = restitution.value(i, j, 1.0),
                                     .friction_coefficient = friction.value(i, j, 0.0),
                                     .tangential_stiffness_ratio = stiffness_ratio.value(i, j, 1.0),
                                     .tangential_damping_ratio = damping_ratio.value(i, j, 1.0),
                                     .work_of_adhesion = adhesion.value(i, j, 0.0),
                                     .rolling_friction = rolling.value(i, j, 0.0)};
      const CoarseGrainRatios ratios{lmp.force->cg(i), lmp.force->cg(j)};
      contacts_[i * stride_ + j] = GrainContact(original, ratios, settings.stiffness_exponent);
      has_surface_forces_ |= contacts_[i * stride_ + j].has_surface_forces();
    }
  }
}

}  // namespace gasgrain::plugins
