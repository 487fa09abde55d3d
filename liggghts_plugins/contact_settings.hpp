// Settings of `model cgm` that are not material properties, and their keywords in a script.
#pragma once

#include "coupling/shared/coarse_grain_scaling.hpp"

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
}

namespace gasgrain::plugins {

enum class TangentialModel { off, no_history, history };

struct ContactSettings {
  TangentialModel tangential = TangentialModel::history;
  StiffnessExponent stiffness_exponent;
};

struct Arguments {
  int count;
  char** values;
};

// Reads `stiffness_exponent n` into `settings`; `where` begins every message. Throws UserError for
// an unknown keyword, a missing or malformed value or n outside [1, 3].
void read_contact_settings(ContactSettings& settings, Arguments arguments, const char* where);

// A number of a script; throws UserError that names `where`, the keyword and the text.
double script_number(const char* text, const char* where, const char* keyword);

// Walls follow the stiffness exponent of the pair style in use unless they state their own: the
// pair style registers its settings here while it lives.
void set_pair_settings(const LAMMPS_NS::LAMMPS& lmp, const ContactSettings* settings);
// Settings of the pair style `gran model cgm` in use, or nullptr.
const ContactSettings* pair_settings(const LAMMPS_NS::LAMMPS& lmp);

}  // namespace gasgrain::plugins
