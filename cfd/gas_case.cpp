#include "cfd/gas_case.hpp"

#include <algorithm>

#include "cfd/time_step.hpp"
#include "coupling/files/sdf_file.hpp"
#include "coupling/shared/drag.hpp"
#include "coupling/shared/text.hpp"

namespace gasgrain::cfd {

namespace {

// Keys first, so that a mistyped required key is named as such and not as missing.
void expect_only(const ConfigTable& table, std::initializer_list<const char*> keys) {
  for (const char* key : keys) table.has(key);
  table.reject_unknown_keys();
}

Grid read_grid(const ConfigTable& table) {
  expect_only(table, {"lower", "upper", "cells"});
  Grid grid;
  grid.lower = table.vector("lower");
  grid.upper = table.vector("upper");
  grid.cells = table.integers3("cells", {.lower = 1, .upper = 1e6});
  if (!((grid.upper - grid.lower).minCoeff() > 0.0)) {
    table.fail("upper", "is " + text(grid.upper) + ", but must exceed grid.lower = " +
                            text(grid.lower) + " in every component");
  }
  return grid;
}

GasProperties read_gas(const ConfigTable& table) {
  expect_only(table, {"density", "viscosity", "gravity"});
  GasProperties gas;
  gas.density = table.number("density", Range::positive());
  gas.viscosity = table.number("viscosity", Range::non_negative());
  gas.gravity = table.vector_or("gravity", gas.gravity);
  return gas;
}

Convection read_convection(const ConfigTable& table) {
  const std::string name =
      table.choice_or("convection", "van-leer", {"van-leer", "central", "none"});
  return name == "none"      ? Convection::none
         : name == "central" ? Convection::central
                             : Convection::van_leer;
}

PressureMethod read_pressure_solver(const ConfigTable& table) {
  const std::string name = table.choice_or(
      "pressure_solver", "multigrid",
      {"multigrid", "hypre-pfmg", "hypre-pfmg-rap", "hypre-smg", "hypre-boomeramg"});
  return name == "hypre-pfmg"        ? PressureMethod::hypre_pfmg
         : name == "hypre-pfmg-rap"  ? PressureMethod::hypre_pfmg_rap
         : name == "hypre-smg"       ? PressureMethod::hypre_smg
         : name == "hypre-boomeramg" ? PressureMethod::hypre_boomeramg
                                     : PressureMethod::multigrid;
}

PressureFallback read_pressure_fallback(const ConfigTable& table) {
  const std::string name = table.choice_or("pressure_fallback", "hypre-boomeramg",
                                           {"hypre-boomeramg", "hypre-pfmg", "none"});
  return name == "none"         ? PressureFallback::none
         : name == "hypre-pfmg" ? PressureFallback::hypre_pfmg
                                : PressureFallback::hypre_boomeramg;
}

void read_body_method(Numerics& numerics, const ConfigTable& table) {
  const bool forcing = table.choice_or("immersed_boundary", "interpolation",
                                       {"interpolation", "volume-forcing"}) == "volume-forcing";
  numerics.immersed_boundary = forcing ? BodyMethod::volume_forcing : BodyMethod::interpolation;
  if (!forcing && table.has("density_scaling")) {
    table.fail("density_scaling",
               "belongs to immersed_boundary = \"volume-forcing\"; remove it or set that");
  }
  numerics.density_scaling =
      table.number_or("density_scaling", numerics.density_scaling, {.lower = 1.0, .upper = 1e12});
}

// After the keys that it depends on.
void read_viscosity(Numerics& numerics, const ConfigTable& table) {
  if (table.choice_or("viscosity", "explicit", {"explicit", "implicit"}) == "explicit") return;
  numerics.viscosity = Viscosity::implicit_step;
  if (numerics.time_scheme != TimeScheme::ab2) {
    table.fail("viscosity", "is \"implicit\", which needs time_scheme = \"ab2\"");
  }
  if (numerics.immersed_boundary != BodyMethod::interpolation) {
    table.fail("viscosity", "is \"implicit\", which needs immersed_boundary = \"interpolation\"");
  }
}

Numerics read_numerics(const ConfigTable& table) {
  expect_only(table,
              {"convection", "pressure_solver", "pressure_fallback", "pressure_tolerance",
               "pressure_iterations", "reference_pressure", "time_scheme", "courant_number",
               "largest_step", "ranks", "immersed_boundary", "density_scaling", "viscosity"});
  Numerics n;
  n.convection = read_convection(table);
  n.pressure_solver = read_pressure_solver(table);
  n.pressure_fallback = read_pressure_fallback(table);
  n.pressure_tolerance =
      table.number_or("pressure_tolerance", n.pressure_tolerance, {.lower = 1e-14, .upper = 0.1});
  n.pressure_iterations = static_cast<int>(table.integer_or(
      "pressure_iterations", n.pressure_iterations, {.lower = 1, .upper = 100000}));
  n.reference_pressure = table.number_or("reference_pressure", n.reference_pressure);
  const bool rk2 = table.choice_or("time_scheme", "ab2", {"ab2", "rk2"}) == "rk2";
  n.time_scheme = rk2 ? TimeScheme::rk2 : TimeScheme::ab2;
  const double largest = stability_of(n.time_scheme).courant_number;
  n.courant_number = table.number_or("courant_number", largest,
                                     {.lower = 0.0, .upper = largest, .lower_open = true});
  n.largest_step = table.number_or("largest_step", n.largest_step, Range::positive());
  read_body_method(n, table);
  read_viscosity(n, table);
  if (table.has("ranks")) n.ranks = table.integers3("ranks", {.lower = 1, .upper = 1e6});
  return n;
}

InitialState read_initial(const ConfigTable& table) {
  expect_only(table, {"velocity"});
  InitialState initial;
  initial.velocity = table.vector_or("velocity", initial.velocity);
  return initial;
}

FixedBed read_fixed_bed(const ConfigTable& file, const Grid& grid) {
  FixedBed bed;
  bed.present = file.has("fixed_bed");
  if (!bed.present) return bed;
  const ConfigTable table = file.table("fixed_bed");
  expect_only(table, {"void_fraction", "diameter", "lower", "upper", "drag"});
  bed.void_fraction = table.number(
      "void_fraction", {.lower = 0.0, .upper = 1.0, .lower_open = true, .upper_open = true});
  bed.diameter = table.number("diameter", Range::positive());
  bed.lower = table.vector_or("lower", grid.lower);
  bed.upper = table.vector_or("upper", grid.upper);
  bed.drag = table.choice_or("drag", bed.drag, drag_closure_names());
  if (!((bed.upper - bed.lower).minCoeff() > 0.0)) {
    table.fail("upper", "is " + text(bed.upper) + ", but must exceed fixed_bed.lower = " +
                            text(bed.lower) + " in every component");
  }
  return bed;
}

RunControl read_run(const ConfigTable& table) {
  expect_only(table, {"end_time", "step", "checkpoint_interval", "restart"});
  RunControl run;
  run.end_time = table.number_or("end_time", run.end_time, Range::non_negative());
  run.step = table.number_or("step", run.step, Range::non_negative());
  run.checkpoint_interval =
      table.number_or("checkpoint_interval", run.checkpoint_interval, Range::non_negative());
  run.restart = table.text_or("restart", run.restart);
  if (!run.restart.empty() && run.restart != latest_checkpoint) {
    run.restart = table.resolve_path(run.restart);
  }
  return run;
}

std::vector<std::string> read_output_fields(const ConfigTable& table) {
  const std::vector<std::string> fields = table.texts("fields");
  const std::string remedy =
      "; give some of \"velocity\", \"pressure\", \"void_fraction\" and "
      "\"wall_fraction\"";
  if (fields.empty()) table.fail("fields", "is empty" + remedy);
  for (auto field = fields.begin(); field != fields.end(); ++field) {
    const auto& names = output_field_names;
    if (std::find(names.begin(), names.end(), *field) == names.end()) {
      table.fail("fields", "has no field '" + *field + "'" + remedy);
    }
    if (std::find(fields.begin(), field, *field) != field) {
      table.fail("fields", "names '" + *field + "' twice" + remedy);
    }
  }
  return fields;
}

Output read_output(const ConfigTable& table) {
  expect_only(table, {"directory", "interval", "fields"});
  Output output;
  output.directory = table.text_or("directory", output.directory);
  output.interval = table.number_or("interval", output.interval, Range::non_negative());
  if (table.has("fields")) output.fields = read_output_fields(table);
  return output;
}

}  // namespace

GasCase read_gas_case(const ConfigTable& file) {
  for (const char* key : {"grid", "gas", "boundary", "body", "numerics", "initial", "fixed_bed",
                          "run", "output", "probe", "coupling"}) {
    file.has(key);
  }
  file.reject_unknown_keys();
  GasCase result;
  result.grid = read_grid(file.table("grid"));
  result.gas = read_gas(file.table("gas"));
  result.boundaries = read_boundaries(file.table("boundary"));
  result.bodies = read_bodies(file, load_sdf_shape);
  result.patches =
      read_patches(file.table("boundary"), result.boundaries, result.bodies, load_sdf_shape);
  result.numerics = read_numerics(file.table_or_empty("numerics"));
  result.initial = read_initial(file.table_or_empty("initial"));
  result.fixed_bed = read_fixed_bed(file, result.grid);
  result.run = read_run(file.table_or_empty("run"));
  check_time_tables(file.table("boundary"), result.boundaries, result.patches, result.run.end_time);
  result.output = read_output(file.table_or_empty("output"));
  result.probes = read_probes(file, result.grid, result.bodies);
  result.statements = file.statements();
  return result;
}

}  // namespace gasgrain::cfd
