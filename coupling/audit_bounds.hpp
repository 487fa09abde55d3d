// Section [coupling.audit]: how large a residual (-) may be, and what happens beyond.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "coupling/shared/config_table.hpp"

namespace gasgrain::coupling {

enum class OnViolation { warn, stop };

struct AuditBounds {
  double momentum = 1e-6;        // vertical balance, over the weight
  double exchange = 1e-11;       // drag on grains against drag on gas
  double pressure_force = 1e-6;  // the same for -V grad p
  double solid_volume = 1e-11;   // in the cells against the grains'
  double divergence = 1e-4;      // of the gas
  double heating = 0.1;          // energy from nowhere over kinetic and elastic energy and a lift
  OnViolation on_violation = OnViolation::warn;
};

// What was measured, in the same order and meaning.
struct AuditResiduals {
  double momentum, exchange, pressure_force, solid_volume, divergence, heating;
};

// What the user should know about possible causes.
struct AuditCauses {
  std::vector<std::string> unmeasured_walls;
  long unexplained_grains = 0;  // that appeared or left without notice
};

inline constexpr std::array bound_names = {"momentum",     "exchange",   "pressure_force",
                                           "solid_volume", "divergence", "heating"};

struct AuditViolation {
  std::string name;  // as the key of its bound
  std::string text;  // value, bound, cause, remedy
};

AuditBounds read_audit_bounds(const ConfigTable& table);  // throws UserError

std::vector<AuditViolation> violations(const AuditBounds& bounds, const AuditResiduals& residuals,
                                       const AuditCauses& causes);

}  // namespace gasgrain::coupling
