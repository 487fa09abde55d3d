// Reads the properties of original particles that a script states by fix property/global.
#pragma once

#include <vector>

#include "liggghts_plugins/contact_coefficients.hpp"
#include "liggghts_plugins/contact_settings.hpp"

namespace gasgrain::plugins {

// The contact law of every pair of atom types; types count from 1.
class GrainContactTable {
 public:
  GrainContactTable() = default;
  // Of the single type 1, for hosts other than LIGGGHTS.
  explicit GrainContactTable(const GrainContact& contact) : stride_(2), contacts_(4, contact) {}
  // Reads, for the types of the simulation box (all `peratomtypepair`):
  //   cgmSpringConstant            k, N/m             required
  //   coefficientRestitution       e, (0, 1]          required
  //   coefficientFriction          mu >= 0            required unless tangential is off
  //   cgmTangentialStiffnessRatio  k_t / k > 0        1 when absent
  //   cgmTangentialDampingRatio    eta_t / eta >= 0   1 when absent
  //   cgmWorkOfAdhesion            w >= 0, J/m^2      0 when absent
  //   cgmRollingFriction           mu_r >= 0          0 when absent
  // and the coarse-grain ratios of the `coarsegraining` command. `where` begins every message.
  // Throws UserError: a property missing, out of range or not symmetric.
  GrainContactTable(LAMMPS_NS::LAMMPS& lmp, const ContactSettings& settings, const char* where);

  const GrainContact& operator()(int first_type, int second_type) const {
    return contacts_[first_type * stride_ + second_type];
  }
  // Whether any pair of types has adhesion or rolling friction.
  bool has_surface_forces() const { return has_surface_forces_; }

 private:
  bool has_surface_forces_ = false;
  int stride_ = 0;
  std::vector<GrainContact> contacts_;
};

}  // namespace gasgrain::plugins
