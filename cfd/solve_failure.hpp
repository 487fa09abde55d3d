// A step that went wrong, and where and why.
#pragma once

#include <string>

#include "coupling/shared/error.hpp"

namespace gasgrain::cfd {

class GasSolver;
struct StepReport;

// The velocity is no longer finite, or the pressure equation was not solved. Thrown on every rank.
class SolveFailure : public UserError {
 public:
  using UserError::UserError;
};

// Names field, cell and position of the first value that is not finite, or of the largest velocity
// when all are, and the likely cause with its remedy. `last` is the report of the last good step,
// of length `last_dt` [s], 0 when there was none. Collective.
std::string describe_failure(GasSolver& solver, const StepReport& last, double last_dt);

}  // namespace gasgrain::cfd
