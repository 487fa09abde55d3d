#include "liggghts_plugins/style_registry.hpp"

#include <fix.h>
#include <input.h>
#include <lammps.h>
#include <modify.h>

#include <algorithm>
#include <map>

#include "liggghts_plugins/private_member.hpp"

namespace gasgrain::plugins {

struct FixMap {
  using Member = std::map<std::string, FixCreator>* LAMMPS_NS::Modify::*;
  friend Member private_member(FixMap);
};

struct CommandMap {
  using Member = std::map<std::string, CommandCreator>* LAMMPS_NS::Input::*;
  friend Member private_member(CommandMap);
};

namespace {

std::vector<StyleDescription>& styles() {
  static std::vector<StyleDescription> list;
  return list;
}

}  // namespace

template struct GrantAccess<FixMap, &LAMMPS_NS::Modify::fix_map>;
template struct GrantAccess<CommandMap, &LAMMPS_NS::Input::command_map>;

void register_fix(LAMMPS_NS::LAMMPS& lmp, const std::string& name, FixCreator create) {
  (*(lmp.modify->*private_member(FixMap())))[name] = create;
}

FixCreator fix_creator(LAMMPS_NS::LAMMPS& lmp, const std::string& name) {
  const auto& creators = *(lmp.modify->*private_member(FixMap()));
  const auto found = creators.find(name);
  return found == creators.end() ? nullptr : found->second;
}

void register_command(LAMMPS_NS::LAMMPS& lmp, const std::string& name, CommandCreator create) {
  (*(lmp.input->*private_member(CommandMap())))[name] = create;
}

void describe_style(const StyleDescription& style) {
  const bool known = std::any_of(styles().begin(), styles().end(),
                                 [&](const auto& s) { return s.usage == style.usage; });
  if (!known) styles().push_back(style);
}

const std::vector<StyleDescription>& described_styles() {
  return styles();
}

}  // namespace gasgrain::plugins
