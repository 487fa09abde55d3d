// Adds fixes and commands to a running, unmodified LIGGGHTS, and keeps the list for --help.
#pragma once

#include <string>
#include <vector>

namespace LAMMPS_NS {  // NOLINT(readability-identifier-naming): the name of LIGGGHTS
class LAMMPS;
class Fix;
}  // namespace LAMMPS_NS

namespace gasgrain::plugins {

using FixCreator = LAMMPS_NS::Fix* (*)(LAMMPS_NS::LAMMPS*, int argument_count, char** arguments);
using CommandCreator = void (*)(LAMMPS_NS::LAMMPS*, int argument_count, char** arguments);

// How a style appears in --help.
struct StyleDescription {
  std::string usage;          // as in a script: "fix ID group wall/sdf ..."
  std::string summary;        // one line
  std::string documentation;  // page in docs/
};

// Makes `fix ID group NAME ...` known to this LIGGGHTS instance. Call again after a `clear`.
void register_fix(LAMMPS_NS::LAMMPS& lmp, const std::string& name, FixCreator create);
// Who creates `fix ID group NAME`, or nullptr.
FixCreator fix_creator(LAMMPS_NS::LAMMPS& lmp, const std::string& name);
// Makes the command NAME known; replaces a stock command of that name.
void register_command(LAMMPS_NS::LAMMPS& lmp, const std::string& name, CommandCreator create);

// Adds an entry to the list that --help prints; the same usage is listed once.
void describe_style(const StyleDescription& style);
const std::vector<StyleDescription>& described_styles();

template <class FixClass>
LAMMPS_NS::Fix* create_fix(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments) {
  return new FixClass(lmp, argument_count, arguments);
}

template <class CommandClass>
void run_command(LAMMPS_NS::LAMMPS* lmp, int argument_count, char** arguments) {
  CommandClass(lmp).command(argument_count, arguments);
}

}  // namespace gasgrain::plugins
