#include "coupling/audit_bounds.hpp"

#include <cmath>

#include "coupling/shared/text.hpp"

namespace gasgrain::coupling {

namespace {

std::string momentum_cause(const AuditCauses& causes) {
  if (!causes.unmeasured_walls.empty()) {
    return "nobody measures the force of wall fix " + causes.unmeasured_walls.front() +
           "; use fix wall/sdf or fix wall/gran model cgm";
  }
  if (causes.unexplained_grains != 0) {
    return text(
        "%ld grains appeared or left by a command that does not tell: their momentum is "
        "not counted",
        causes.unexplained_grains);
  }
  return "another fix acts on the grains, or the pressure solve is too coarse; see "
         "numerics.pressure_tolerance";
}

}  // namespace

AuditBounds read_audit_bounds(const ConfigTable& table) {
  AuditBounds bounds;
  const auto read = [&](const char* key, double& bound) {
    bound = table.number_or(key, bound, Range::positive());
  };
  read("momentum", bounds.momentum);
  read("exchange", bounds.exchange);
  read("pressure_force", bounds.pressure_force);
  read("solid_volume", bounds.solid_volume);
  read("divergence", bounds.divergence);
  read("heating", bounds.heating);
  bounds.on_violation = table.choice_or("on_violation", "warn", {"warn", "stop"}) == "stop"
                            ? OnViolation::stop
                            : OnViolation::warn;
  table.reject_unknown_keys();
  return bounds;
}

std::vector<AuditViolation> violations(const AuditBounds& bounds, const AuditResiduals& residuals,
                                       const AuditCauses& causes) {
  std::vector<AuditViolation> found;
  const auto check = [&](const char* name, double value, double bound, const std::string& cause) {
    if (std::abs(value) <= bound) return;
    found.push_back({name, text("%s residual %.2g exceeds coupling.audit.%s = %.2g: ", name, value,
                                name, bound) +
                               cause});
  };
  check("momentum", residuals.momentum, bounds.momentum, momentum_cause(causes));
  check("exchange", residuals.exchange, bounds.exchange,
        "gas and grains do not exchange opposite drag; this is an error of gasgrain, please report "
        "it");
  check("pressure_force", residuals.pressure_force, bounds.pressure_force,
        "the grains felt another pressure gradient than the gas; shorten the exchange interval so "
        "that it is not divided while bodies move");
  check("solid_volume", residuals.solid_volume, bounds.solid_volume,
        "solid volume was lost in the mapping; this is an error of gasgrain, please report it");
  check("divergence", residuals.divergence, bounds.divergence,
        "the pressure solve is too coarse; lower numerics.pressure_tolerance");
  check("heating", residuals.heating, bounds.heating,
        "the grains gained energy that neither gas nor weight gave; is the DEM step beyond an "
        "eighth of the contact time?");
  return found;
}

}  // namespace gasgrain::coupling
