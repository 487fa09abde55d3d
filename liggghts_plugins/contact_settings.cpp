#include "liggghts_plugins/contact_settings.hpp"

#include <cstdlib>
#include <iterator>
#include <map>
#include <string>

#include "coupling/shared/error.hpp"

namespace gasgrain::plugins {

namespace {

std::map<const LAMMPS_NS::LAMMPS*, const ContactSettings*>& settings_of_pair_styles() {
  static std::map<const LAMMPS_NS::LAMMPS*, const ContactSettings*> settings;
  return settings;
}

[[noreturn]] void unknown_keyword(const std::string& word, const char* where) {
  static const std::string known[] = {"stiffness_exponent"};
  const std::string nearest = nearest_name(word, std::begin(known), std::end(known));
  throw UserError(std::string(where) + ": unknown keyword '" + word + "'" +
                  (nearest.empty() ? "" : ", did you mean '" + nearest + "'?") +
                  " (known after the models: stiffness_exponent)");
}

}  // namespace

double script_number(const char* text, const char* where, const char* keyword) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end == text || *end != '\0')
    throw UserError(std::string(where) + ": " + keyword + " needs a number, got '" + text + "'");
  return value;
}

void read_contact_settings(ContactSettings& settings, Arguments arguments, const char* where) {
  for (int i = 0; i < arguments.count; i += 2) {
    const std::string keyword = arguments.values[i];
    if (keyword != "stiffness_exponent") unknown_keyword(keyword, where);
    if (i + 1 >= arguments.count)
      throw UserError(std::string(where) + ": stiffness_exponent needs a value in [1, 3]");
    const double n = script_number(arguments.values[i + 1], where, "stiffness_exponent");
    if (!(n >= 1.0 && n <= 3.0))
      throw UserError(std::string(where) + ": stiffness_exponent = " + arguments.values[i + 1] +
                      " is outside [1, 3]; 3 keeps the contact time, 1 is geometric similarity");
    settings.stiffness_exponent.value = n;
  }
}

void set_pair_settings(const LAMMPS_NS::LAMMPS& lmp, const ContactSettings* settings) {
  if (settings)
    settings_of_pair_styles()[&lmp] = settings;
  else
    settings_of_pair_styles().erase(&lmp);
}

const ContactSettings* pair_settings(const LAMMPS_NS::LAMMPS& lmp) {
  const auto found = settings_of_pair_styles().find(&lmp);
  return found == settings_of_pair_styles().end() ? nullptr : found->second;
}

}  // namespace gasgrain::plugins
