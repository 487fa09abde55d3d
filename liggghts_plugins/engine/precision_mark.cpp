#include "liggghts_plugins/engine/precision_mark.hpp"

#include <comm.h>
#include <domain.h>
#include <fix.h>
#include <lammps.h>
#include <modify.h>

#include <array>
#include <cstdio>
#include <string>

#include "liggghts_plugins/style_registry.hpp"

namespace gasgrain::plugins {

namespace {

constexpr const char* style = "gasgrain/mixed_precision";
constexpr const char* name = "gasgrain_mixed_precision";

class FixMixedPrecision : public LAMMPS_NS::Fix {
 public:
  FixMixedPrecision(LAMMPS_NS::LAMMPS* liggghts, int argument_count, char** arguments)
      : Fix(liggghts, argument_count, arguments) {
    restart_global = 1;
  }
  int setmask() override { return 0; }
  // The mark is that the file names the fix.
  void write_restart(FILE* file) override {
    if (comm->me != 0) return;
    const int size = 0;
    std::fwrite(&size, sizeof size, 1, file);
  }
  void restart(char*) override {}
};

void tell_conversion(const LAMMPS_NS::LAMMPS& lmp, bool to_mixed) {
  if (lmp.comm->me != 0) return;
  const std::string line =
      std::string("Engine: the restart file was written in ") +
      (to_mixed ? "full precision and the run goes on in mixed: tangential springs are rounded"
                : "mixed precision and the run goes on in full") +
      "; its bits are not those of a run without this change\n";
  for (FILE* file : {lmp.screen, lmp.logfile})
    if (file) std::fputs(line.c_str(), file);
}

}  // namespace

void mark_precision(LAMMPS_NS::LAMMPS& lmp, Precision precision) {
  if (!lmp.domain->box_exist) return;  // LIGGGHTS refuses to run
  LAMMPS_NS::Modify& modify = *lmp.modify;
  const bool mixed = precision == Precision::mixed;
  if (modify.fix_restart_in_progress() && modify.have_restart_data_style(style) != mixed)
    tell_conversion(lmp, mixed);
  const bool marked = modify.find_fix(name) >= 0;
  if (marked && !mixed) modify.delete_fix(name);
  if (marked || !mixed) return;
  register_fix(lmp, style, create_fix<FixMixedPrecision>);
  std::array<std::string, 3> words = {name, "all", style};
  std::array<char*, 3> arguments = {words[0].data(), words[1].data(), words[2].data()};
  modify.add_fix(static_cast<int>(arguments.size()), arguments.data());
}

}  // namespace gasgrain::plugins
