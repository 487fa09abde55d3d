#include "liggghts_plugins/coarsegraining.h"

#include <error.h>
#include <force.h>
#include <modify.h>

#include <string>
#include <vector>

#include "coupling/shared/error.hpp"
#include "liggghts_plugins/coarse_grain_report.hpp"
#include "liggghts_plugins/contact_settings.hpp"
#include "liggghts_plugins/register.hpp"

namespace LAMMPS_NS {

namespace {

using gasgrain::UserError;

constexpr const char* where = "coarsegraining";

struct Request {
  std::vector<double> ratios;
  bool error_on_unscaled_models = true;
};

void read_model_check(Request& request, const char* value) {
  const std::string check = value ? value : "";
  if (check != "error" && check != "warn")
    throw UserError(std::string(where) + ": model_check is 'error' or 'warn', not '" + check + "'");
  request.error_on_unscaled_models = check == "error";
}

Request read_arguments(int count, char** arguments) {
  Request request;
  for (int i = 0; i < count; ++i) {
    if (std::string(arguments[i]) == "model_check") {
      read_model_check(request, i + 1 < count ? arguments[i + 1] : nullptr);
      if (i + 2 < count)
        throw UserError(std::string(where) + ": unexpected '" + arguments[i + 2] +
                        "' after model_check");
      break;
    }
    const double l = gasgrain::plugins::script_number(arguments[i], where, "the ratio l");
    if (!(l >= 1.0))
      throw UserError(std::string(where) + ": l = " + arguments[i] +
                      " must be >= 1 (1 = original particles)");
    request.ratios.push_back(l);
  }
  if (request.ratios.empty())
    throw UserError(std::string(where) + ": needs l, as one value or one value per atom type");
  return request;
}

}  // namespace

void Coarsegraining::command(int argument_count, char** arguments) {
  const Request request = read_arguments(argument_count, arguments);
  refuse_if_late();
  gasgrain::plugins::register_styles(*lmp);  // once more after a `clear`
  gasgrain::plugins::coarse_grain_report(*lmp) = {.ratios = request.ratios};
  force->error_coarsegraining_ = request.error_on_unscaled_models;
  force->warn_coarsegraining_ = !request.error_on_unscaled_models;
  // with l = 1 throughout there is nothing to scale, and stock models need not be warned of
  if (gasgrain::plugins::coarse_grain_report(*lmp).scales())
    for (const double l : request.ratios) force->setCG(l);
}

// Stock LIGGGHTS applies l where a style is read or first set up.
void Coarsegraining::refuse_if_late() const {
  if (force->cg_active()) throw UserError(std::string(where) + ": given twice");
  if (force->pair)
    throw UserError(std::string(where) +
                    ": must come before pair_style and read_restart, whose models scale with l");
  if (modify->n_fixes_style("particletemplate") > 0)
    throw UserError(std::string(where) +
                    ": must come before fix particletemplate, whose radius scales with l");
}

}  // namespace LAMMPS_NS
